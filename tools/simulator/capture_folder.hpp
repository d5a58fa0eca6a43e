#pragma once

#include "pipeline/base/error.hpp"
#include "tools/simulator/renderer.hpp"

#include <filesystem>
#include <functional>

namespace bodyscan::simulator {

// What is known about a rendered capture.
struct Truth {
  Scene scene;
  TruthMaps maps;
};

// What the camera takes of a pattern as the frame of this index. Called from several threads.
using Photograph = std::function<ColorImage8(const Pattern& pattern, int index)>;

// Takes every pattern of the sequence into an existing folder, with the capture.json that tells them apart.
// The options give the files' format.
Expected<void> write_capture(const std::filesystem::path& folder, const PatternSequence& sequence,
                             const Photograph& photograph, const RenderOptions& options);

// Renders a capture folder (capture.json, frames, calibration.yml) and beside it in truth/: depth.pfm,
// normal.pfm, rows.pfm, columns.pfm, reachable.png, mesh.obj (camera frame as it is: x right, y down; sRGB
// albedo as vertex colours) and scene.json (facts in the camera frame and the settings).
Expected<Truth> render_capture(const RenderOptions& options);

}  // namespace bodyscan::simulator
