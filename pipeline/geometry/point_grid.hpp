#pragma once

#include "pipeline/base/image.hpp"

#include <cmath>

namespace bodyscan {

struct Point3f {
  float x = 0;
  float y = 0;
  float z = 0;

  friend bool operator==(const Point3f&, const Point3f&) = default;
};

// Surface points on the camera's pixel grid, mm in the camera frame (x right, y down, z forward).
struct PointGrid {
  Image<Point3f> points;  // z is NaN where there is no point
  FloatImage sigma_mm;    // standard deviation of the depth; meaningless where there is no point

  [[nodiscard]] bool has(int x, int y) const { return !std::isnan(points(x, y).z); }
};

}  // namespace bodyscan
