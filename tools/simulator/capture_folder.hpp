#pragma once

#include "pipeline/base/error.hpp"
#include "tools/simulator/renderer.hpp"

namespace bodyscan::simulator {

// What is known about a rendered capture.
struct Truth {
  Scene scene;
  TruthMaps maps;
};

// Renders a capture folder (capture.json, frames, calibration.yml) and beside it in truth/: depth.pfm,
// normal.pfm, rows.pfm, columns.pfm, reachable.png, mesh.obj (camera frame as it is: x right, y down; sRGB
// albedo as vertex colours) and scene.json (facts in the camera frame and the settings).
Expected<Truth> render_capture(const RenderOptions& options);

}  // namespace bodyscan::simulator
