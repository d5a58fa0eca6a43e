#include "pipeline/calibration/rig_model.hpp"
#include "tests/pipeline/calibration/synthetic_session.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

struct Method {
  const char* name;
  std::function<PoseKind(int)> kind;
};
class Calibrating : public testing::TestWithParam<Method> {};

TEST_P(Calibrating, FindsTheRig) {
  SessionOptions options;
  options.kind = GetParam().kind;
  const SyntheticSession session = make_session(options);
  const auto result = calibrate(session.request);
  ASSERT_TRUE(result) << result.error().message;
  expect_near_truth(*result, session.truth, 1e-3);
  EXPECT_NEAR(result->report.camera_rms_px, std::sqrt(2.0) * options.camera_noise_px, 0.02);
  EXPECT_LT(result->report.projector_rms_px, 0.08);
  EXPECT_LT(std::abs(result->report.square_error_percent.value()), 0.03);
  for (const PoseReport& pose : result->report.poses) {
    EXPECT_TRUE(pose.used) << pose.name << ": " << pose.reason;
    EXPECT_LT(pose.plane_rms_mm, 0.3);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Methods, Calibrating,
    testing::Values(Method{"gray_code", [](int) { return PoseKind::gray_code; }},
                    Method{"pairs", [](int) { return PoseKind::pair; }},
                    Method{"mixed", [](int i) { return i % 2 == 0 ? PoseKind::gray_code : PoseKind::pair; }}),
    [](const auto& instance) { return std::string(instance.param.name); });

// Pairs are less exact than captures; that is no reason to leave them out.
TEST(CalibratingMixed, KeepsPairsThatAreLessExactThanCaptures) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    SessionOptions options;
    options.kind = [](int i) { return i < 4 ? PoseKind::gray_code : PoseKind::pair; };
    options.beam_noise_px = 0.35;
    options.seed = seed;
    const SyntheticSession session = make_session(options);
    const auto result = calibrate(session.request);
    ASSERT_TRUE(result) << result.error().message;
    expect_near_truth(*result, session.truth, 1e-3);
    for (const PoseReport& pose : result->report.poses) EXPECT_TRUE(pose.used) << pose.name << pose.reason;
    EXPECT_LE(result->report.corners_left_out, 2);
  }
}

TEST(CalibratingMixed, ALonePairIsKeptAndABadOneIsNot) {
  SessionOptions options;
  options.kind = [](int i) { return i == 2 ? PoseKind::pair : PoseKind::gray_code; };
  options.beam_noise_px = 0.25;
  SyntheticSession session = make_session(options);
  const auto good = calibrate(session.request);
  ASSERT_TRUE(good) << good.error().message;
  EXPECT_TRUE(good->report.poses[2].used) << good->report.poses[2].reason;
  for (Beam& beam : session.request.poses[2].observation.projected) beam.camera_px.y() += 8;
  const auto bad = calibrate(session.request);
  ASSERT_TRUE(bad) << bad.error().message;
  EXPECT_FALSE(bad->report.poses[2].used);
}

// Standard deviations are worth their name: over many sessions the errors are as large as they say.
TEST(CalibratingMixed, KnowsItsUncertainty) {
  double squares = 0;
  int count = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SessionOptions options;
    options.poses = 5;
    options.kind = [](int i) { return i % 2 == 0 ? PoseKind::gray_code : PoseKind::pair; };
    options.seed = seed;
    const SyntheticSession session = make_session(options);
    const auto result = calibrate(session.request);
    ASSERT_TRUE(result) << result.error().message;
    for (const auto& [name, truth] :
         {std::pair("camera fx", session.truth.camera.fx),
          std::pair("projector fx", session.truth.projector.fx),
          std::pair("translation x", session.truth.projector_from_camera.translation.x()),
          std::pair("translation z", session.truth.projector_from_camera.translation.z())}) {
      const ParameterReport& report = parameter(result->report, name);
      ASSERT_TRUE(report.sigma) << name;
      squares += std::pow((report.value - truth) / *report.sigma, 2);
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 1, 0.4);
}

TEST(CalibratingFew, LeavesOneOutAndPredictsIt) {
  const auto result = calibrate(make_session().request);
  ASSERT_TRUE(result);
  const CalibrationReport& report = result->report;
  ASSERT_TRUE(report.leave_one_out_camera_px && report.leave_one_out_square_error_percent);
  EXPECT_GT(*report.leave_one_out_camera_px, 0.9 * report.camera_rms_px);
  EXPECT_LT(*report.leave_one_out_camera_px, 1.5 * report.camera_rms_px);
  EXPECT_LT(std::abs(*report.leave_one_out_square_error_percent), 0.05);
}

TEST(CalibratingFew, FixesWhatTheDataCannotTell) {
  SessionOptions options;
  SyntheticSession session = make_session(options);
  const auto result = calibrate(session.request);
  ASSERT_TRUE(result);
  // The rig has square pixels and no third radial term.
  for (const char* name : {"camera fy / fx", "camera k3", "projector fy / fx", "projector k3"}) {
    EXPECT_FALSE(parameter(result->report, name).estimated) << name;
    EXPECT_GT(parameter(result->report, name).sigma.value_or(0), 0) << name;
  }
  EXPECT_EQ(result->calibration.camera.fx, result->calibration.camera.fy);
  EXPECT_EQ(result->calibration.camera.distortion[4], 0);
  EXPECT_TRUE(parameter(result->report, "camera k1").estimated);
  const bool told = std::ranges::any_of(result->report.advice, [](const std::string& line) {
    return line.find("camera k3") != std::string::npos;
  });
  EXPECT_TRUE(told);
}

// A third term without a second one would be the second one's stand-in.
TEST(CalibratingFew, FixesHigherTermsBeforeLower) {
  SyntheticSession session = make_session();
  session.truth.projector.distortion = {-0.02, 0, 0, 0, 2.5};
  for (std::size_t i = 0; i < session.request.poses.size(); ++i)
    session.request.poses[i].observation = observe(session.truth, session.board, session.camera_from_board[i],
                                                   {}, PoseKind::gray_code, static_cast<unsigned>(i));
  const auto result = calibrate(session.request);
  ASSERT_TRUE(result) << result.error().message;
  ASSERT_TRUE(parameter(result->report, "projector k3").estimated);
  EXPECT_TRUE(parameter(result->report, "projector k2").estimated);
}

TEST(CalibratingFew, SaysWhatItDoesNotTryWithFewPoses) {
  SessionOptions options;
  options.poses = 4;
  const auto result = calibrate(make_session(options).request);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_FALSE(parameter(result->report, "camera k3").estimated);
  EXPECT_FALSE(parameter(result->report, "camera k3").sigma);
  EXPECT_TRUE(std::ranges::any_of(result->report.advice, [](const std::string& line) {
    return line.find("fewer than five poses") != std::string::npos;
  }));
}

TEST(CalibratingFew, NamesAPoseThatRepeatsAnother) {
  const SessionOptions options;
  SyntheticSession session = make_session(options);
  RigidTransform again = session.camera_from_board[3];
  again.rotation = again.rotation * rotation_of({0.03, -0.02, 0});
  again.translation.x() += 10;
  session.request.poses[6].observation =
      observe(session.truth, session.board, again, options, PoseKind::gray_code, 99);
  session.request.poses[6].observation.name = "pose 6";
  const auto result = calibrate(session.request);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(result->report.poses[6].used);
  EXPECT_EQ(result->report.poses[6].notes,
            std::vector<std::string>{
                "nearly parallel to pose 3 (2.1 degrees) and at the same place: adds nothing new"});
  for (std::size_t i = 0; i < 6; ++i) EXPECT_TRUE(result->report.poses[i].notes.empty()) << i;

  again.translation.x() += 80;  // elsewhere it tells something
  session.request.poses[6].observation =
      observe(session.truth, session.board, again, options, PoseKind::gray_code, 99);
  EXPECT_TRUE(calibrate(session.request)->report.poses[6].notes.empty());
}

TEST(CalibratingAlike, ParallelBoardsAreRefusedOrFlagged) {
  SessionOptions options;
  options.poses = 4;
  options.largest_tilt_degrees = 0.3;
  options.distance_spread = 0.02;
  const auto result = calibrate(make_session(options).request);
  std::string told;
  if (result) {
    for (const std::string& line : result->report.advice) told += line + "\n";
  } else {
    told = result.error().message;
  }
  EXPECT_NE(told.find("nearly parallel"), std::string::npos) << told;
  EXPECT_NE(told.find("tilt"), std::string::npos) << told;
  EXPECT_NE(told.find("nearer"), std::string::npos) << told;
}

TEST(CalibratingAlike, SuggestsThePoseThatHelpsMost) {
  SessionOptions options;
  options.largest_tilt_degrees = 6;
  options.poses = 4;
  SyntheticSession session = make_session(options);
  const auto before = calibrate(session.request);
  ASSERT_TRUE(before) << before.error().message;
  const auto suggested = std::ranges::find_if(before->report.advice, [](const std::string& line) {
    return line.find("one more pose would help most") != std::string::npos;
  });
  ASSERT_NE(suggested, before->report.advice.end());
  EXPECT_NE(suggested->find("tilted"), std::string::npos) << *suggested;
}

// Pictures of a rig whose projector is turned about its axis, its projected boards counted as a picture
// shows them: their columns to the right, or downwards.
SyntheticSession rolled_session(double turn, const std::function<PoseKind(int)>& kind) {
  SessionOptions options;
  options.poses = 5;
  options.kind = kind;
  SyntheticSession session = make_session(options);
  RigidTransform& pose = session.truth.projector_from_camera;
  pose = RigidTransform{rotation_of({0, 0, turn}), Eigen::Vector3d::Zero()} * pose;
  session.truth.projector.cy = 383.5;
  for (std::size_t i = 0; i < session.request.poses.size(); ++i) {
    PoseObservation& seen = session.request.poses[i].observation;
    seen = observe(session.truth, session.board, session.camera_from_board[i], options,
                   kind(static_cast<int>(i)), 7);
    if (seen.projected.empty()) continue;
    const Eigen::Vector2d along = seen.projected[1].camera_px - seen.projected[0].camera_px;
    if (along.x() + along.y() > 0) continue;
    for (Beam& beam : seen.projected) beam.projector_px = options.projected.half_turned(beam.projector_px);
  }
  return session;
}

TEST(CalibratingRolled, FindsAProjectorOnItsSideAndUpsideDown) {
  const auto gray = [](int) { return PoseKind::gray_code; };
  const auto mixed = [](int pose) { return pose == 4 ? PoseKind::gray_code : PoseKind::pair; };
  for (const double turn : {M_PI / 2, M_PI, -M_PI / 2}) {
    for (const std::function<PoseKind(int)>& kind : {std::function<PoseKind(int)>(gray), {mixed}}) {
      const SyntheticSession session = rolled_session(turn, kind);
      const auto result = calibrate(session.request);
      ASSERT_TRUE(result) << result.error().message;
      expect_near_truth(*result, session.truth, 1e-3);
      EXPECT_LT(
          (result->calibration.projector_from_camera.rotation - session.truth.projector_from_camera.rotation)
              .norm(),
          0.01);
      for (const PoseReport& pose : result->report.poses) EXPECT_TRUE(pose.used) << pose.reason;
    }
  }
}

TEST(CalibratingRolled, PairsAloneSayThatTheyDoNotTellUpsideDown) {
  const SyntheticSession session = rolled_session(0, [](int) { return PoseKind::pair; });
  const auto result = calibrate(session.request);
  ASSERT_TRUE(result) << result.error().message;
  expect_near_truth(*result, session.truth, 1e-3);
  EXPECT_TRUE(std::ranges::any_of(result->report.advice, [](const std::string& line) {
    return line.find("upside down") != std::string::npos;
  }));
}

// A capture that is not used tells nothing about the pairs.
TEST(CalibratingPairs, ABlurredCaptureDoesNotTurnTheProjector) {
  SessionOptions options;
  options.poses = 6;
  options.kind = [](int i) { return i == 5 ? PoseKind::gray_code : PoseKind::pair; };
  for (unsigned seed = 1; seed <= 3; ++seed) {
    options.seed = seed;
    SyntheticSession session = make_session(options);
    session.request.poses[5].edge_blur_px = 9;
    const auto result = calibrate(session.request);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_FALSE(result->report.poses[5].used);
    EXPECT_LT(
        (result->calibration.projector_from_camera.rotation - session.truth.projector_from_camera.rotation)
            .norm(),
        0.02);
    EXPECT_TRUE(std::ranges::any_of(result->report.advice, [](const std::string& line) {
      return line.find("upside down") != std::string::npos;
    }));
  }
}

// It looks the same from all four sides.
TEST(CalibratingPairs, ASquareProjectedBoardIsTurnedAsTheCapturesSay) {
  SessionOptions options;
  options.projected = {7, 7, {300, 180}, 70};
  options.kind = [](int i) { return i < 3 ? PoseKind::gray_code : PoseKind::pair; };
  for (int quarters = 0; quarters < 4; ++quarters) {
    SyntheticSession session = make_session(options);
    for (CalibrationPose& pose : session.request.poses)
      for (Beam& beam : pose.observation.projected)
        for (int i = 0; i < quarters; ++i)
          beam.projector_px = options.projected.quarter_turned(beam.projector_px);
    const auto result = calibrate(session.request);
    ASSERT_TRUE(result) << result.error().message;
    expect_near_truth(*result, session.truth, 1e-3);
    for (const PoseReport& pose : result->report.poses) EXPECT_TRUE(pose.used) << pose.name << pose.reason;
  }
}

}  // namespace
}  // namespace bodyscan
