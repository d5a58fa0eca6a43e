#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/geometry/point_grid.hpp"

#include <array>

namespace bodyscan {

struct Pixel {
  int x;
  int y;

  friend bool operator==(const Pixel&, const Pixel&) = default;
};

struct FitLimits {
  float error_mm;
  float color;  // levels
};

// Whether the triangle between the points at three pixels stands for every point at the pixels it covers, rim
// included: each point's foot on its plane, or where the ray to the point meets it, lies in the triangle and
// no further than `error_mm`, and the interpolated colour within `color` levels. Its sides must be
// horizontal, vertical or at 45 degrees; all points covered must exist. `colors` may be null.
[[nodiscard]] bool triangle_fits(const Image<Point3f>& points, const ColorImage8* colors,
                                 const std::array<Pixel, 3>& corners, const FitLimits& limits);

}  // namespace bodyscan
