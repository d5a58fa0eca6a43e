#include "tools/evaluate/shape_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace bodyscan {
namespace {

Eigen::Vector3d mean(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

// |x|^2 = 2 c.x + (r^2 - |c|^2), linear in c and the bracket; about `origin` for the sake of precision.
Sphere algebraic_sphere(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& origin) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d local = point - origin;
    const Eigen::Vector4d row(2 * local.x(), 2 * local.y(), 2 * local.z(), 1);
    normal += row * row.transpose();
    right += row * local.squaredNorm();
  }
  const Eigen::Vector4d solution = normal.ldlt().solve(right);
  const Eigen::Vector3d center = solution.head<3>();
  return {center + origin, std::sqrt(std::max(0.0, solution[3] + center.squaredNorm()))};
}

}  // namespace

Plane fit_plane(std::span<const Eigen::Vector3d> points) {
  const Eigen::Vector3d center = mean(points);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) scatter += (point - center) * (point - center).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  Plane plane{solver.eigenvectors().col(0), 0};
  if (plane.normal.dot(center) > 0) plane.normal = -plane.normal;
  plane.offset = plane.normal.dot(center);
  return plane;
}

Sphere fit_sphere(std::span<const Eigen::Vector3d> points) {
  Sphere sphere = algebraic_sphere(points, mean(points));
  for (int iteration = 0; iteration < 20; ++iteration) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const Eigen::Vector3d& point : points) {
      const Eigen::Vector3d away = point - sphere.center;
      const double length = away.norm();
      Eigen::Vector4d row;
      row << -away / length, -1;  // d distance / d (center, radius)
      normal += row * row.transpose();
      right -= row * (length - sphere.radius);
    }
    const Eigen::Vector4d step = normal.ldlt().solve(right);
    sphere.center += step.head<3>();
    sphere.radius += step[3];
    if (step.norm() < 1e-10) break;
  }
  return sphere;
}

Regression regress(std::span<const float> x, std::span<const float> y) {
  const double count = static_cast<double>(x.size());
  double mean_x = 0;
  double mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / count;
    mean_y += y[i] / count;
  }
  double xx = 0;
  double xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  const double slope = xx > 0 ? xy / xx : 0;
  return {slope, mean_y - slope * mean_x};
}

}  // namespace bodyscan
