#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace bodyscan {

// Points x with normal . x = offset; the normal has unit length.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0;  // mm

  [[nodiscard]] double distance(const Eigen::Vector3d& point) const { return normal.dot(point) - offset; }
};

struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;  // mm

  [[nodiscard]] double distance(const Eigen::Vector3d& point) const {
    return (point - center).norm() - radius;
  }
};

// Total least squares; the normal points towards the origin (the camera). Needs three points.
Plane fit_plane(std::span<const Eigen::Vector3d> points);

// Least squares of the geometric distances: Gauss-Newton from the algebraic fit. Needs four points.
Sphere fit_sphere(std::span<const Eigen::Vector3d> points);

// Ordinary least squares y = slope * x + intercept; slope 0 where x does not vary.
struct Regression {
  double slope = 0;
  double intercept = 0;
};
Regression regress(std::span<const float> x, std::span<const float> y);

}  // namespace bodyscan
