#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/geometry/calibration.hpp"

#include <string>

namespace bodyscan::simulator {

// A nominal rig: a Nikon D5000 with a 35 mm lens at the origin, and a projector whose picture's centre is
// aimed at the point 1.05 m in front of the camera.
struct RigOptions {
  std::string name = "rows";  // where the projector stands: rows, columns or diagonal
  double scale = 0.5;         // camera pixels over the full 4288 x 2848
  Size projector{1024, 768};
  double projector_roll = 0;  // degrees, about the projector's own axis
};

// An error of kind `usage` that starts with `option` where no built-in rig can have such a projector.
Expected<void> check_projector_size(Size size, const std::string& option);

// "rows": 268 mm below the camera, so that depth moves a point along the projector's rows' numbers;
// "columns": 272 mm beside it; "diagonal": 190 mm below and 190 mm beside. A roll nearer to 90 or 270 degrees
// than to 0 or 180 swaps below and beside, so that the same axis of the projector still carries the depth.
Expected<Calibration> make_rig(const RigOptions& options);

}  // namespace bodyscan::simulator
