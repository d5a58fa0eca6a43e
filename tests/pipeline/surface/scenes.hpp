#pragma once

#include "pipeline/geometry/lens.hpp"
#include "pipeline/geometry/point_grid.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace bodyscan::scenes {

inline constexpr float none = std::numeric_limits<float>::quiet_NaN();

// A small camera with the D5000's viewing angle and footprint at a quarter of its resolution.
inline Lens camera(int width = 200, int height = 140) {
  return {.size = {width, height},
          .fx = 1590,
          .fy = 1590,
          .cx = (width - 1) / 2.0,
          .cy = (height - 1) / 2.0,
          .distortion = {}};
}

// The point of depth z (NaN: none) seen at a pixel.
inline Point3f point_at(const Lens& lens, int x, int y, double z) {
  return {static_cast<float>((x - lens.cx) / lens.fx * z), static_cast<float>((y - lens.cy) / lens.fy * z),
          static_cast<float>(z)};
}

// The grid of the depth map depth(x, y).
template <class Depth>
PointGrid grid(const Lens& lens, const Depth& depth, float sigma_mm = 0.03F) {
  PointGrid result{Image<Point3f>(lens.size), FloatImage(lens.size, sigma_mm)};
  for (int y = 0; y < lens.size.height; ++y) {
    for (int x = 0; x < lens.size.width; ++x) result.points(x, y) = point_at(lens, x, y, depth(x, y));
  }
  return result;
}

// The depth at a pixel of a plane through (0, 0, z0) whose depth grows by `slope` mm a mm to the right.
inline double inclined_plane(const Lens& lens, int x, double z0, double slope) {
  return z0 / (1 - slope * (x - lens.cx) / lens.fx);
}

class Noise {
 public:
  explicit Noise(double sigma) : normal_(0, sigma) {}
  double operator()() { return normal_(engine_); }

 private:
  std::mt19937 engine_{7};
  std::normal_distribution<double> normal_;
};

}  // namespace bodyscan::scenes
