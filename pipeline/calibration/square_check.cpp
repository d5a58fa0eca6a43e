#include "pipeline/calibration/square_check.hpp"

#include "pipeline/board/homography.hpp"

#include <cmath>
#include <map>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace bodyscan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Rays (x/z, y/z, 1) in which the projector sees the printed corners.
std::map<int, Vector3d> projector_rays(const Calibration& calibration, const PoseObservation& pose) {
  std::map<int, Vector3d> rays;
  for (const SeenCorner& seen : pose.in_projector) rays[seen.corner] = calibration.projector.ray(seen.px);
  if (pose.projected.empty()) return rays;
  std::vector<Vector2d> camera;
  std::vector<Vector2d> projector;
  for (const Beam& beam : pose.projected) {
    camera.emplace_back(calibration.camera.ray(beam.camera_px).head<2>());
    projector.emplace_back(calibration.projector.ray(beam.projector_px).head<2>());
  }
  const auto homography = fit_homography(camera, projector);
  if (!homography) return rays;
  for (const SeenCorner& seen : pose.in_camera) {
    const Vector2d ideal = calibration.camera.ray(seen.px).head<2>();
    rays[seen.corner] = apply_homography(*homography, ideal).homogeneous();
  }
  return rays;
}

// Middle of the shortest line between the two rays, camera frame.
Vector3d meeting_point(const Calibration& calibration, const Vector3d& camera_ray,
                       const Vector3d& projector_ray) {
  const RigidTransform& transform = calibration.projector_from_camera;
  const Vector3d origin = -transform.rotation.transpose() * transform.translation;
  const Vector3d direction = transform.rotation.transpose() * projector_ray;
  Eigen::Matrix2d normal;
  normal << camera_ray.dot(camera_ray), -camera_ray.dot(direction), -camera_ray.dot(direction),
      direction.dot(direction);
  const Vector2d along = normal.inverse() * Vector2d(camera_ray.dot(origin), -direction.dot(origin));
  return (along[0] * camera_ray + origin + along[1] * direction) / 2;
}

double plane_rms(const std::map<int, Vector3d>& points) {
  if (points.size() < 3) return 0;
  Vector3d mean = Vector3d::Zero();
  for (const auto& [corner, point] : points) mean += point / static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& [corner, point] : points)
    covariance += (point - mean) * (point - mean).transpose() / static_cast<double>(points.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
}

}  // namespace

TriangulatedBoard triangulate_board(const Calibration& calibration, const PrintedBoard& board,
                                    const PoseObservation& pose) {
  const std::map<int, Vector3d> rays = projector_rays(calibration, pose);
  std::map<int, Vector3d> points;
  for (const SeenCorner& seen : pose.in_camera) {
    const auto ray = rays.find(seen.corner);
    if (ray != rays.end())
      points[seen.corner] = meeting_point(calibration, calibration.camera.ray(seen.px), ray->second);
  }
  TriangulatedBoard result;
  for (const auto& [corner, point] : points) {
    const auto add = [&, here = point](int neighbour) {
      const auto other = points.find(neighbour);
      if (other != points.end()) result.sides.push_back((other->second - here).norm() / board.square_mm);
    };
    if (corner % board.columns + 1 < board.columns) add(corner + 1);
    if (corner / board.columns + 1 < board.rows) add(corner + board.columns);
  }
  result.plane_rms_mm = plane_rms(points);
  return result;
}

SideFigures figures_of(const std::vector<double>& sides) {
  if (sides.empty()) return {};
  const double count = static_cast<double>(sides.size());
  double mean = 0;
  for (const double side : sides) mean += side / count;
  double squares = 0;
  for (const double side : sides) squares += (side - mean) * (side - mean) / count;
  return {.error_percent = 100 * (mean - 1), .spread_percent = 100 * std::sqrt(squares)};
}

}  // namespace bodyscan
