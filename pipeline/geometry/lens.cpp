#include "pipeline/geometry/lens.hpp"

#include <Eigen/LU>

namespace bodyscan {
namespace {

// Distorted point and its derivative by the ideal one.
struct Distorted {
  Eigen::Vector2d point;
  Eigen::Matrix2d jacobian;
};

Distorted distort_with_jacobian(const std::array<double, 5>& coefficients, const Eigen::Vector2d& ideal) {
  const auto [k1, k2, p1, p2, k3] = coefficients;
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3));  // d radial / d r2, doubled
  Distorted result;
  result.point = {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                  y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
  const double cross = x * y * slope + 2 * p1 * x + 2 * p2 * y;
  result.jacobian << radial + x * x * slope + 2 * p1 * y + 6 * p2 * x, cross, cross,
      radial + y * y * slope + 6 * p1 * y + 2 * p2 * x;
  return result;
}

}  // namespace

Eigen::Vector2d Lens::distort(const Eigen::Vector2d& ideal) const {
  return distort_with_jacobian(distortion, ideal).point;
}

Eigen::Vector2d Lens::undistort(const Eigen::Vector2d& distorted) const {
  Eigen::Vector2d ideal = distorted;
  for (int i = 0; i < 20; ++i) {
    const Distorted at = distort_with_jacobian(distortion, ideal);
    const Eigen::Vector2d step = at.jacobian.inverse() * (distorted - at.point);
    if (!step.allFinite()) break;
    ideal += step;
    if (step.squaredNorm() < 1e-28) break;
  }
  return ideal;
}

Eigen::Vector2d Lens::project(const Eigen::Vector3d& point) const {
  const Eigen::Vector2d d = distort(point.head<2>() / point.z());
  return {fx * d.x() + cx, fy * d.y() + cy};
}

Eigen::Vector3d Lens::ray(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d ideal = undistort({(pixel.x() - cx) / fx, (pixel.y() - cy) / fy});
  return {ideal.x(), ideal.y(), 1};
}

}  // namespace bodyscan
