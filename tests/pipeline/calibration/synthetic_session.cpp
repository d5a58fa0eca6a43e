#include "tests/pipeline/calibration/synthetic_session.hpp"

#include "pipeline/calibration/rig_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double degree = std::numbers::pi / 180;

}  // namespace

Calibration sample_rig() {
  Calibration rig;
  rig.camera = {{2144, 1424}, 3180, 3180, 1077, 708, {-0.091, 0.113, 4e-4, -3e-4, 0}};
  rig.projector = {{1024, 768}, 1505, 1505, 511.5, 660, {-0.021, 0.017, -2e-4, 3e-4, 0}};
  rig.projector_from_camera.rotation = rotation_of({-0.02, 0.18, 0.01});
  const Vector3d position(190, 190, 0);  // of the projector, mm
  rig.projector_from_camera.translation = -rig.projector_from_camera.rotation * position;
  return rig;
}

PoseObservation observe(const Calibration& rig, const PrintedBoard& board,
                        const RigidTransform& camera_from_board, const SessionOptions& options, PoseKind kind,
                        unsigned seed, double scale) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto noise = [&](double sigma) { return Vector2d(sigma * normal(random), sigma * normal(random)); };
  PoseObservation pose;
  for (int i = 0; i < board.corner_count(); ++i) {
    const Vector2d corner = scale * board.corner_mm(i);
    const Vector3d point = camera_from_board * Vector3d(corner.x(), corner.y(), 0);
    pose.in_camera.push_back({i, rig.camera.project(point) + noise(options.camera_noise_px)});
    if (kind == PoseKind::gray_code)
      pose.in_projector.push_back(
          {i, rig.projector.project(rig.projector_from_camera * point) + noise(options.projector_noise_px)});
  }
  if (kind == PoseKind::gray_code) return pose;
  // Projected corners: the projector's rays meet the board's plane.
  const Eigen::Matrix3d camera_from_projector = rig.projector_from_camera.rotation.transpose();
  const Vector3d origin = -camera_from_projector * rig.projector_from_camera.translation;
  const Vector3d plane = camera_from_board.rotation.col(2);
  for (int i = 0; i < options.projected.corner_count(); ++i) {
    const Vector3d direction = camera_from_projector * rig.projector.ray(options.projected.corner_px(i));
    const double along = plane.dot(camera_from_board.translation - origin) / plane.dot(direction);
    const Vector3d point = origin + along * direction;
    pose.projected.push_back(
        {options.projected.corner_px(i),
         rig.camera.project(point) + noise(options.beam_noise_px.value_or(options.camera_noise_px))});
  }
  return pose;
}

SyntheticSession make_session(const SessionOptions& options) {
  SyntheticSession session;
  session.truth = sample_rig();
  session.request.board = session.board;
  session.request.camera = session.truth.camera.size;
  session.request.projector = session.truth.projector.size;
  session.request.projected_board = options.projected;
  const Vector3d middle(100, 75, 0);
  for (int i = 0; i < options.poses; ++i) {
    const double turn = 2 * std::numbers::pi * i / options.poses;
    const double tilt = options.largest_tilt_degrees * degree;
    RigidTransform pose;
    pose.rotation = rotation_of({tilt * std::cos(turn), tilt * std::sin(turn), 0.3 * std::sin(2 * turn)});
    const double distance = 1050 + 1000 * options.distance_spread * std::cos(2 * turn + 1);
    pose.translation =
        Vector3d(90 * std::cos(turn + 2), 50 * std::sin(turn + 2), distance) - pose.rotation * middle;
    session.camera_from_board.push_back(pose);
    CalibrationPose seen;
    seen.observation = observe(session.truth, session.board, pose, options, options.kind(i),
                               options.seed * 1000 + static_cast<unsigned>(i));
    seen.observation.name = "pose " + std::to_string(i);
    seen.edge_blur_px = 1;
    session.request.poses.push_back(std::move(seen));
  }
  return session;
}

double baseline(const Calibration& calibration) {
  return calibration.projector_from_camera.translation.norm();
}

void expect_near_truth(const CalibrationResult& result, const Calibration& truth, double relative) {
  EXPECT_NEAR(result.calibration.camera.fx / truth.camera.fx, 1, relative);
  EXPECT_NEAR(result.calibration.projector.fx / truth.projector.fx, 1, relative);
  EXPECT_NEAR(baseline(result.calibration) / baseline(truth), 1, relative);
}

const ParameterReport& parameter(const CalibrationReport& report, const std::string& name) {
  const auto found = std::ranges::find(report.parameters, name, &ParameterReport::name);
  if (found == report.parameters.end()) throw std::runtime_error("no parameter " + name);
  return *found;
}

}  // namespace bodyscan
