#pragma once

#include "pipeline/geometry/calibration.hpp"
#include "pipeline/pattern/sequence.hpp"

#include <filesystem>

namespace bodyscan {

// A camera of 160 x 120 pixels and a projector of 32 x 24, 270 mm below it, that looks at the same wall.
Calibration small_calibration();

// What the camera sees of one pattern on a white wall 1 m away, with light and blur, as an 8-bit PNG file.
void write_photograph(const std::filesystem::path& path, const Pattern& pattern, Size camera);

// A capture of that wall: capture.json, frame_00.png (white), frame_01.png (black), ..., calibration.yml.
void write_small_capture(const std::filesystem::path& folder);

}  // namespace bodyscan
