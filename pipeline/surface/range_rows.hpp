#pragma once

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/geometry/point_grid.hpp"

#include <limits>
#include <vector>

namespace bodyscan {

// One row of points in the form the neighbour tests work on, padded with NaN on both sides. With s = |P|^2
// and a pixel step of 1/f in x/z, the tangent of the incidence angle between neighbours 1 and 2 is
//   |s1 - s2| / (z1 + z2) / ((z1 + z2) / 2f)
// times sqrt(1 + (y/z)^2) (horizontally; vertically with x/z), which is left out: at most 5 % for a D5000.
class RangeRow {
 public:
  static constexpr int padding = 2;

  explicit RangeRow(int width) : s_(width + 2 * padding, std::numeric_limits<float>::quiet_NaN()), z_(s_) {}

  [[nodiscard]] float* s() { return s_.data() + padding; }
  [[nodiscard]] float* z() { return z_.data() + padding; }
  [[nodiscard]] const float* s() const { return s_.data() + padding; }
  [[nodiscard]] const float* z() const { return z_.data() + padding; }

  void clear() {
    s_.assign(s_.size(), std::numeric_limits<float>::quiet_NaN());
    z_ = s_;
  }

 private:
  std::vector<float> s_;  // squared range, mm^2
  std::vector<float> z_;  // mm
};

struct RangeRowKernel {
  // s and z of `width` points; NaN where there is none or `removed` (may be null) is not 0.
  BODYSCAN_KERNEL void run(const Point3f* points, const unsigned char* removed, int width, float* s,
                           float* z) {
    for (int x = 0; x < width; ++x) {
      const Point3f p = points[x];
      s[x] = p.x * p.x + p.y * p.y + p.z * p.z;
      z[x] = p.z;
    }
    if (!removed) return;
    for (int x = 0; x < width; ++x) {
      const float none = std::numeric_limits<float>::quiet_NaN();
      s[x] = removed[x] ? none : s[x];
      z[x] = removed[x] ? none : z[x];
    }
  }
};

}  // namespace bodyscan
