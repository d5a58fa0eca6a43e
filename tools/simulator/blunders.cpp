#include "tools/simulator/blunders.hpp"

#include <numbers>

#include <Eigen/Geometry>

namespace bodyscan::simulator {
namespace {

using Eigen::Vector3d;

Vector3d middle_of(const SessionPose& pose) {
  return pose.first_camera_from_board * pose.sheet.point(pose.sheet.middle());
}

// Moves the sheet to the left until a quarter of its width is outside the picture.
void cut(const Calibration& calibration, SessionPose& pose) {
  const Lens& camera = calibration.camera;
  const Eigen::Vector2d quarter =
      pose.sheet.middle() - pose.sheet.half_sheet().x() / 2 * Eigen::Vector2d::UnitX();
  const Vector3d there = pose.first_camera_from_board * pose.sheet.point(quarter);
  const double border = camera.ray({-0.5, camera.project(there).y()}).x() * there.z();
  const Vector3d step(border - there.x(), 0, 0);
  pose.first_camera_from_board.translation += step;
  pose.second_camera_from_board.translation += step;
}

void move(SessionPose& pose) {
  constexpr double distance_mm = 4;
  constexpr double angle = std::numbers::pi / 180;
  const Vector3d middle = middle_of(pose);
  const Vector3d step = distance_mm * Vector3d(2, 1, 2).normalized();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vector3d(1, 1, 1).normalized()).toRotationMatrix();
  const RigidTransform& first = pose.first_camera_from_board;
  pose.second_camera_from_board = {turn * first.rotation,
                                   turn * (first.translation - middle) + middle + step};
}

// Another board in the same place.
void exchange(SessionPose& pose, const PrintedBoard& board) {
  const Vector3d before = pose.sheet.point(pose.sheet.middle());
  pose.sheet = PrintedSheet(board, pose.sheet.form());
  const Vector3d shift = before - pose.sheet.point(pose.sheet.middle());
  for (RigidTransform* transform : {&pose.first_camera_from_board, &pose.second_camera_from_board})
    transform->translation = *transform * shift;
}

}  // namespace

void plant(Blunder kind, const Calibration& calibration, SessionPose& pose) {
  constexpr double overexposure = 6;
  constexpr double dark_share = 0.02;
  constexpr double more_blur_px = 5;
  constexpr double larger = 1.04;
  PrintedBoard board = pose.sheet.board();
  switch (kind) {
    case Blunder::cut:
      cut(calibration, pose);
      break;
    case Blunder::moved:
      move(pose);
      break;
    case Blunder::blurred:
      pose.lens_blur += more_blur_px;
      break;
    case Blunder::size:
      --board.columns;
      exchange(pose, board);
      break;
    case Blunder::scaled:
      board.square_mm *= larger;
      exchange(pose, board);
      break;
    case Blunder::dark:
      pose.second_light *= dark_share;
      break;
    case Blunder::overexposed:
      pose.first_light *= overexposure;
      pose.second_light *= overexposure;
      break;
  }
  pose.blunders.push_back(kind);
}

}  // namespace bodyscan::simulator
