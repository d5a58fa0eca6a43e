#pragma once

#include "pipeline/base/image.hpp"

#include <algorithm>

#include <Eigen/Core>

namespace bodyscan {

// The image at a place between pixels, bilinear; beyond its border as on it. At least 2 x 2 pixels.
inline double sample(const FloatImage& image, const Eigen::Vector2d& at) {
  const double x = std::clamp(at.x(), 0.0, image.width() - 1.001);
  const double y = std::clamp(at.y(), 0.0, image.height() - 1.001);
  const int left = static_cast<int>(x);
  const int top = static_cast<int>(y);
  const double u = x - left;
  const double v = y - top;
  const float* row = image.row(top) + left;
  const float* below = image.row(top + 1) + left;
  return (static_cast<double>(row[0]) * (1 - u) + static_cast<double>(row[1]) * u) * (1 - v) +
         (static_cast<double>(below[0]) * (1 - u) + static_cast<double>(below[1]) * u) * v;
}

}  // namespace bodyscan
