#include "tools/simulator/blunders.hpp"

#include "tests/tools/simulator/session_test_support.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d middle_of(const PrintedSheet& sheet, const RigidTransform& camera_from_board) {
  return camera_from_board * sheet.point(sheet.middle());
}

class Blunders : public testing::Test {
 protected:
  // One of the sound poses, and the same with a blunder.
  SessionPose planted(Blunder kind) {
    SessionPose pose = sound_;
    plant(kind, truth_.calibration, pose);
    EXPECT_EQ(pose.blunders, std::vector{kind});
    EXPECT_EQ(pose.gray, sound_.gray);
    return pose;
  }
  void expect_same_light(const SessionPose& pose) const {
    EXPECT_EQ(pose.first_light, sound_.first_light);
    EXPECT_EQ(pose.second_light, sound_.second_light);
    EXPECT_EQ(pose.lens_blur, sound_.lens_blur);
  }
  void expect_same_board(const SessionPose& pose) const {
    EXPECT_EQ(pose.sheet.board().columns, 9);
    EXPECT_EQ(pose.sheet.board().rows, 7);
    EXPECT_EQ(pose.sheet.board().square_mm, 25);
    expect_same_form(pose);
  }
  void expect_same_form(const SessionPose& pose) const {
    EXPECT_EQ(pose.sheet.form().bend_mm, sound_.sheet.form().bend_mm);
    EXPECT_EQ(pose.sheet.form().plate_mm, sound_.sheet.form().plate_mm);
    EXPECT_EQ(pose.sheet.form().edge_mm, sound_.sheet.form().edge_mm);
  }
  void expect_same_place(const SessionPose& pose) const {
    expect_still(pose);
    EXPECT_EQ(pose.first_camera_from_board.rotation, sound_.first_camera_from_board.rotation);
    EXPECT_EQ(pose.first_camera_from_board.translation, sound_.first_camera_from_board.translation);
  }
  static void expect_still(const SessionPose& pose) {
    EXPECT_EQ(pose.second_camera_from_board.rotation, pose.first_camera_from_board.rotation);
    EXPECT_EQ(pose.second_camera_from_board.translation, pose.first_camera_from_board.translation);
  }

  SessionTruth truth_ = [] {
    SessionOptions options = small_session(SessionMethod::projected);
    options.bend_mm = 6;
    return plan_session(options).value();
  }();
  SessionPose sound_ = truth_.poses[3];
};

TEST_F(Blunders, CutMovesAQuarterOfTheSheetOutOfThePicture) {
  const SessionPose pose = planted(Blunder::cut);
  constexpr int steps = 80;
  int outside = 0;
  for (int j = 0; j < steps; ++j) {
    for (int i = 0; i < steps; ++i) {
      const Vector2d way = (Vector2d(i, j).array() + 0.5) / (steps / 2) - 1;
      const Vector2d paper = pose.sheet.middle() + way.cwiseProduct(pose.sheet.half_sheet());
      const Vector2d pixel =
          truth_.calibration.camera.project(pose.first_camera_from_board * pose.sheet.point(paper));
      outside += pixel.x() < -0.5;
      EXPECT_LE(pixel.x(), truth_.calibration.camera.size.width - 0.5);
      EXPECT_GE(pixel.y(), -0.5);
      EXPECT_LE(pixel.y(), truth_.calibration.camera.size.height - 0.5);
    }
  }
  EXPECT_NEAR(static_cast<double>(outside) / (steps * steps), 0.25, 0.03);
  expect_still(pose);
  EXPECT_EQ(pose.first_camera_from_board.rotation, sound_.first_camera_from_board.rotation);
  const Vector3d step = pose.first_camera_from_board.translation - sound_.first_camera_from_board.translation;
  EXPECT_EQ(step.tail<2>(), Vector2d(0, 0));
  expect_same_light(pose);
  expect_same_board(pose);
}

TEST_F(Blunders, MovedShiftsAndTurnsTheBoardAfterTheFirstPicture) {
  const SessionPose pose = planted(Blunder::moved);
  const RigidTransform& first = pose.first_camera_from_board;
  const RigidTransform& second = pose.second_camera_from_board;
  EXPECT_EQ(first.rotation, sound_.first_camera_from_board.rotation);
  EXPECT_EQ(first.translation, sound_.first_camera_from_board.translation);
  EXPECT_NEAR((middle_of(pose.sheet, second) - middle_of(pose.sheet, first)).norm(), 4, 1e-9);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(second.rotation * first.rotation.transpose()));
  EXPECT_NEAR(turn.angle(), std::numbers::pi / 180, 1e-9);
  expect_same_light(pose);
  expect_same_board(pose);
}

TEST_F(Blunders, BlurredAddsLensBlur) {
  const SessionPose pose = planted(Blunder::blurred);
  EXPECT_EQ(pose.lens_blur, sound_.lens_blur + 5);
  EXPECT_EQ(pose.first_light, sound_.first_light);
  EXPECT_EQ(pose.second_light, sound_.second_light);
  expect_same_board(pose);
  expect_same_place(pose);
}

TEST_F(Blunders, SizeAndScaledExchangeTheBoardAroundItsMiddle) {
  for (const Blunder kind : {Blunder::size, Blunder::scaled}) {
    const SessionPose pose = planted(kind);
    EXPECT_EQ(pose.sheet.board().columns, kind == Blunder::size ? 8 : 9);
    EXPECT_EQ(pose.sheet.board().rows, 7);
    EXPECT_DOUBLE_EQ(pose.sheet.board().square_mm, kind == Blunder::scaled ? 26 : 25);
    expect_same_form(pose);
    expect_still(pose);
    EXPECT_EQ(pose.first_camera_from_board.rotation, sound_.first_camera_from_board.rotation);
    EXPECT_LT((middle_of(pose.sheet, pose.first_camera_from_board) -
               middle_of(sound_.sheet, sound_.first_camera_from_board))
                  .norm(),
              1e-9);
    expect_same_light(pose);
  }
}

TEST_F(Blunders, DarkDimsAllButTheFirstPicture) {
  const SessionPose pose = planted(Blunder::dark);
  EXPECT_EQ(pose.first_light, sound_.first_light);
  EXPECT_DOUBLE_EQ(pose.second_light, 0.02 * sound_.second_light);
  EXPECT_EQ(pose.lens_blur, sound_.lens_blur);
  expect_same_board(pose);
  expect_same_place(pose);
}

TEST_F(Blunders, OverexposedBrightensAllPictures) {
  const SessionPose pose = planted(Blunder::overexposed);
  EXPECT_DOUBLE_EQ(pose.first_light, 6 * sound_.first_light);
  EXPECT_DOUBLE_EQ(pose.second_light, 6 * sound_.second_light);
  EXPECT_EQ(pose.lens_blur, sound_.lens_blur);
  expect_same_board(pose);
  expect_same_place(pose);
}

TEST_F(Blunders, OnePoseMayHaveSeveral) {
  SessionPose pose = planted(Blunder::moved);
  const Vector3d step = middle_of(pose.sheet, pose.second_camera_from_board) -
                        middle_of(pose.sheet, pose.first_camera_from_board);
  plant(Blunder::size, truth_.calibration, pose);
  plant(Blunder::cut, truth_.calibration, pose);
  EXPECT_EQ(pose.blunders, (std::vector{Blunder::moved, Blunder::size, Blunder::cut}));
  EXPECT_LT((middle_of(pose.sheet, pose.second_camera_from_board) -
             middle_of(pose.sheet, pose.first_camera_from_board) - step)
                .norm(),
            1e-9);
}

TEST(PlannedBlunders, SpoilTheirPoseAlone) {
  SessionOptions options = small_session(SessionMethod::mixed);
  const SessionTruth sound = plan_session(options).value();
  options.blunders = {{2, Blunder::overexposed}, {5, Blunder::moved}, {5, Blunder::dark}};
  const SessionTruth spoilt = plan_session(options).value();
  for (std::size_t i = 0; i < sound.poses.size(); ++i) {
    EXPECT_EQ(spoilt.poses[i].blunders.size(), i == 2 ? 1U : i == 5 ? 2U : 0U);
    EXPECT_EQ(spoilt.poses[i].first_light != sound.poses[i].first_light, i == 2);
    EXPECT_EQ(spoilt.poses[i].second_light != sound.poses[i].second_light, i == 2 || i == 5);
    EXPECT_EQ(spoilt.poses[i].second_camera_from_board.translation !=
                  sound.poses[i].second_camera_from_board.translation,
              i == 5);
    EXPECT_EQ(spoilt.poses[i].first_camera_from_board.translation,
              sound.poses[i].first_camera_from_board.translation);
  }
}

}  // namespace
}  // namespace bodyscan::simulator
