#include "pipeline/calibration/rig_model.hpp"
#include "tests/pipeline/calibration/synthetic_session.hpp"

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

TEST(KeptLenses, OnePoseTellsWhereTheProjectorStands) {
  for (const PoseKind kind : {PoseKind::gray_code, PoseKind::pair}) {
    SessionOptions options;
    options.poses = 1;
    options.kind = [=](int) { return kind; };
    SyntheticSession session = make_session(options);
    Calibration old = session.truth;
    old.projector_from_camera.translation += Eigen::Vector3d(40, -25, 30);
    old.projector_from_camera.rotation =
        rotation_of({0.05, -0.08, 0.02}) * old.projector_from_camera.rotation;
    session.request.kept = {old};
    const auto result = calibrate(session.request);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->calibration.camera.fx, old.camera.fx);
    EXPECT_EQ(result->calibration.projector.distortion, old.projector.distortion);
    EXPECT_LT((result->calibration.projector_from_camera.translation -
               session.truth.projector_from_camera.translation)
                  .norm(),
              3);
    EXPECT_FALSE(parameter(result->report, "camera fx").estimated);
    EXPECT_TRUE(parameter(result->report, "translation x").estimated);
    EXPECT_FALSE(result->report.leave_one_out_camera_px);
    ASSERT_EQ(result->report.advice.size(), 1);
    EXPECT_NE(result->report.advice[0].find("a second one"), std::string::npos);
  }
}

// A board that looks the same upside down: the projector is where it was before, about.
TEST(KeptLenses, TellWhichWayTheProjectedBoardStands) {
  SessionOptions options;
  options.poses = 2;
  options.kind = [](int) { return PoseKind::pair; };
  SyntheticSession session = make_session(options);
  for (CalibrationPose& pose : session.request.poses)
    for (Beam& beam : pose.observation.projected)
      beam.projector_px = shown_board.half_turned(beam.projector_px);
  session.request.kept = {session.truth};
  session.request.kept->calibration.projector_from_camera.translation.x() += 20;
  const auto result = calibrate(session.request);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_LT(
      (result->calibration.projector_from_camera.rotation - session.truth.projector_from_camera.rotation)
          .norm(),
      0.01);
  EXPECT_TRUE(result->report.leave_one_out_projector_px);
}

TEST(KeptLenses, ThatDoNotFitAreRefused) {
  SessionOptions options;
  options.poses = 2;
  SyntheticSession session = make_session(options);
  session.request.kept = {session.truth, 0.07, 0.04};
  ASSERT_TRUE(calibrate(session.request));
  session.request.kept->calibration.projector.fx *= 1.08;
  session.request.kept->calibration.projector.fy *= 1.08;
  const auto result = calibrate(session.request);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("kept lenses do not fit"), std::string::npos)
      << result.error().message;
}

}  // namespace
}  // namespace bodyscan
