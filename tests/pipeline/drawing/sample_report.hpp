#pragma once

#include "pipeline/board/board.hpp"
#include "pipeline/calibration/calibration_report.hpp"

#include <cmath>
#include <random>
#include <string>

#include <Eigen/Geometry>

namespace bodyscan {

// A made-up calibration from poses of a board.
struct SampleReport {
  PrintedBoard board{.columns = 9, .rows = 7, .square_mm = 25};
  Calibration calibration;
  CalibrationReport report;
};

// Of the 63 corners of every pose the first is left out in the camera, and the last two in the projector;
// of several poses pose 2 is left out as a whole. Residuals have a standard deviation of 0.2 px in camera and
// projector, along each direction.
inline SampleReport sample_report(int poses) {
  SampleReport sample;
  sample.calibration.camera = {
      .size = {4288, 2848}, .fx = 5500, .fy = 5500, .cx = 2143, .cy = 1424, .distortion = {}};
  sample.calibration.projector = {
      .size = {1024, 768}, .fx = 1500, .fy = 1500, .cx = 512, .cy = 384, .distortion = {}};
  sample.calibration.projector_from_camera.translation = {0, 190, 0};
  sample.calibration.projector_from_camera.rotation =
      Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()).toRotationMatrix();
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.2);
  const Eigen::Vector2d center = sample.board.corner_mm(sample.board.corner_count() - 1) / 2;
  for (int i = 0; i < poses; ++i) {
    PoseReport pose;
    pose.name = "pose " + std::to_string(i);
    pose.used = i != 2;
    if (!pose.used) pose.reason = "moved between the two pictures";
    const double turn = 2.4 * i;
    const Eigen::Vector3d axis(std::cos(turn), std::sin(turn), 0);
    pose.camera_from_board.rotation = Eigen::AngleAxisd(0.5, axis).toRotationMatrix();
    const Eigen::Vector3d middle(100 * std::cos(1.7 * i), 50 * std::sin(1.7 * i),
                                 850 + 60 * std::cos(3.1 * i));
    pose.camera_from_board.translation =
        middle - pose.camera_from_board.rotation * Eigen::Vector3d(center.x(), center.y(), 0);
    for (int corner = 0; corner < sample.board.corner_count(); ++corner) {
      const Eigen::Vector2d flat = sample.board.corner_mm(corner);
      const Eigen::Vector3d point = pose.camera_from_board * Eigen::Vector3d(flat.x(), flat.y(), 0);
      const Eigen::Vector2d camera_error(noise(random), noise(random));
      const Eigen::Vector2d projector_error(noise(random), noise(random));
      pose.camera.push_back(
          {sample.calibration.camera.project(point) + camera_error, camera_error, corner != 0});
      const Eigen::Vector2d projected =
          sample.calibration.projector.project(sample.calibration.projector_from_camera * point);
      pose.projector.push_back(
          {projected + projector_error, projector_error, corner < sample.board.corner_count() - 2});
    }
    sample.report.poses.push_back(std::move(pose));
  }
  sample.report.camera_rms_px = 0.28;
  sample.report.projector_rms_px = 0.29;
  return sample;
}

}  // namespace bodyscan
