#include "pipeline/calibration/rig_model.hpp"
#include "tests/pipeline/calibration/synthetic_session.hpp"

#include <algorithm>

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
      beam.projector_px = options.projected.half_turned(beam.projector_px);
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

// How well captures fitted says nothing about the pair that finds the projector again.
TEST(KeptLenses, OfCapturesServeAPairToo) {
  SessionOptions options;
  options.poses = 1;
  options.kind = [](int) { return PoseKind::pair; };
  options.beam_noise_px = 0.3;
  SyntheticSession session = make_session(options);
  session.request.kept = {session.truth, 0.02, 0.02};
  const auto result = calibrate(session.request);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_GT(result->report.projector_rms_px, 0.12);
}

TEST(KeptLenses, OneBadPoseOfThreeIsLeftOut) {
  for (const PoseKind kind : {PoseKind::gray_code, PoseKind::pair}) {
    SessionOptions options;
    options.poses = 3;
    options.kind = [=](int) { return kind; };
    SyntheticSession session = make_session(options);
    RigidTransform later = session.camera_from_board[1];
    later.translation += Eigen::Vector3d(1, -2, 4);
    const PoseObservation after = observe(session.truth, session.board, later, options, kind, 99);
    session.request.poses[1].observation.in_projector = after.in_projector;
    session.request.poses[1].observation.projected = after.projected;
    session.request.kept = {session.truth};
    const auto result = calibrate(session.request);
    ASSERT_TRUE(result) << result.error().message;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(result->report.poses[i].used, i != 1) << i;
    EXPECT_NE(result->report.poses[1].reason.find("moved"), std::string::npos);
  }
}

TEST(KeptLenses, AProjectorFarFromWhereItStoodIsNoted) {
  SessionOptions options;
  options.poses = 2;
  SyntheticSession session = make_session(options);
  session.request.kept = {session.truth};
  const auto told = [&] {
    const auto result = calibrate(session.request);
    return result && std::ranges::any_of(result->report.advice, [](const std::string& line) {
             return line.find("mirrored") != std::string::npos;
           });
  };
  EXPECT_FALSE(told());
  session.request.kept->calibration.projector_from_camera.translation.x() *= -1;
  EXPECT_TRUE(told());
}

}  // namespace
}  // namespace bodyscan
