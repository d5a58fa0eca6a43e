#include "pipeline/geometry/lens.hpp"

#include "pipeline/geometry/distortion.hpp"

#include <cmath>

namespace bodyscan {

Eigen::Vector2d Lens::distort(const Eigen::Vector2d& ideal) const {
  const auto at = Distortion<double>(distortion)(ideal.x(), ideal.y());
  return {at.x, at.y};
}

Eigen::Vector2d Lens::undistort(const Eigen::Vector2d& distorted) const {
  const Distortion<double> model(distortion);
  Eigen::Vector2d ideal = distorted;
  for (int i = 0; i < 20; ++i) {
    const auto at = model(ideal.x(), ideal.y());
    const double dx = distorted.x() - at.x;
    const double dy = distorted.y() - at.y;
    const double determinant = at.x_by_x * at.y_by_y - at.x_by_y * at.x_by_y;
    const Eigen::Vector2d step((at.y_by_y * dx - at.x_by_y * dy) / determinant,
                               (at.x_by_x * dy - at.x_by_y * dx) / determinant);
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
