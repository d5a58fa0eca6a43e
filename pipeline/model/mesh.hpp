#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/geometry/point_grid.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace bodyscan {

using Face = std::array<std::uint32_t, 3>;  // indices of points, counter-clockwise seen from outside

// A coloured triangle mesh; without faces it is a point cloud.
struct Mesh {
  std::vector<Point3f> points;  // mm
  std::vector<Rgb8> colors;     // sRGB, one a point, or none at all
  std::vector<Face> faces;
};

}  // namespace bodyscan
