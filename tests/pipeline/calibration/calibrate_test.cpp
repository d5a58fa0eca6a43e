#include "pipeline/calibration/rig_model.hpp"
#include "tests/pipeline/calibration/synthetic_session.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

const ParameterReport& parameter(const CalibrationReport& report, const std::string& name) {
  const auto found = std::ranges::find(report.parameters, name, &ParameterReport::name);
  EXPECT_NE(found, report.parameters.end()) << name;
  return *found;
}

void expect_near_truth(const CalibrationResult& result, const Calibration& truth, double relative) {
  EXPECT_NEAR(result.calibration.camera.fx / truth.camera.fx, 1, relative);
  EXPECT_NEAR(result.calibration.projector.fx / truth.projector.fx, 1, relative);
  EXPECT_NEAR(baseline(result.calibration) / baseline(truth), 1, relative);
}

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
  EXPECT_LT(std::abs(result->report.square_error_percent), 0.03);
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
  EXPECT_GT(result->report.leave_one_out_camera_px, 0.9 * result->report.camera_rms_px);
  EXPECT_LT(result->report.leave_one_out_camera_px, 1.5 * result->report.camera_rms_px);
  EXPECT_LT(std::abs(result->report.leave_one_out_square_error_percent), 0.05);
}

TEST(CalibratingFew, FixesWhatTheDataCannotTell) {
  SessionOptions options;
  SyntheticSession session = make_session(options);
  const auto result = calibrate(session.request);
  ASSERT_TRUE(result);
  // The rig has square pixels and no third radial term.
  for (const char* name : {"camera fy / fx", "camera k3", "projector fy / fx", "projector k3"}) {
    EXPECT_FALSE(parameter(result->report, name).sigma) << name;
  }
  EXPECT_EQ(result->calibration.camera.fx, result->calibration.camera.fy);
  EXPECT_EQ(result->calibration.camera.distortion[4], 0);
  EXPECT_TRUE(parameter(result->report, "camera k1").sigma);
  const bool told = std::ranges::any_of(result->report.advice, [](const std::string& line) {
    return line.find("camera k3") != std::string::npos;
  });
  EXPECT_TRUE(told);
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
  EXPECT_EQ(result->report.poses[6].reason,
            "nearly parallel to pose 3 (2.1 degrees) and at the same place: adds nothing new");
  for (int i = 0; i < 6; ++i) EXPECT_EQ(result->report.poses[static_cast<std::size_t>(i)].reason, "");

  again.translation.x() += 80;  // elsewhere it tells something
  session.request.poses[6].observation =
      observe(session.truth, session.board, again, options, PoseKind::gray_code, 99);
  EXPECT_EQ(calibrate(session.request)->report.poses[6].reason, "");
}

TEST(CalibratingOutliers, FalseCornersAreLeftOut) {
  SyntheticSession session = make_session();
  auto& corners = session.request.poses[2].observation;
  corners.in_camera[10].px += Eigen::Vector2d(4, -3);
  corners.in_projector[20].px += Eigen::Vector2d(-2, 5);
  const auto result = calibrate(session.request);
  ASSERT_TRUE(result);
  expect_near_truth(*result, session.truth, 1e-3);
  EXPECT_TRUE(result->report.poses[2].used);
  EXPECT_FALSE(result->report.poses[2].camera[10].used);
  EXPECT_FALSE(result->report.poses[2].projector[20].used);
  EXPECT_LT(result->report.camera_rms_px, 0.09);
}

struct BadPose {
  const char* name;
  std::function<void(SyntheticSession&, const SessionOptions&)> spoil;  // pose 3
  const char* reason;
};
void PrintTo(const BadPose& pose, std::ostream* out) {
  *out << pose.name;
}
class Spoilt : public testing::TestWithParam<BadPose> {};

TEST_P(Spoilt, PoseIsNamedAndLeftOut) {
  for (const PoseKind kind : {PoseKind::gray_code, PoseKind::pair}) {
    SessionOptions options;
    options.kind = [=](int) { return kind; };
    SyntheticSession session = make_session(options);
    const auto clean = calibrate(session.request);
    ASSERT_TRUE(clean);
    GetParam().spoil(session, options);
    const auto result = calibrate(session.request);
    ASSERT_TRUE(result) << result.error().message;
    for (std::size_t i = 0; i < result->report.poses.size(); ++i)
      EXPECT_EQ(result->report.poses[i].used, i != 3) << i << ": " << result->report.poses[i].reason;
    EXPECT_NE(result->report.poses[3].reason.find(GetParam().reason), std::string::npos)
        << result->report.poses[3].reason;
    EXPECT_LT(result->report.joint_rms_px, 1.2 * clean->report.joint_rms_px);
    expect_near_truth(*result, session.truth, 1e-3);
  }
}

PoseKind kind_of(const PoseObservation& pose) {
  return pose.projected.empty() ? PoseKind::gray_code : PoseKind::pair;
}

INSTANTIATE_TEST_SUITE_P(
    Poses, Spoilt,
    testing::Values(BadPose{"moved_between_the_pictures",
                            [](SyntheticSession& session, const SessionOptions& options) {
                              PoseObservation& pose = session.request.poses[3].observation;
                              RigidTransform later = session.camera_from_board[3];
                              later.translation += Eigen::Vector3d(1, -2, 4);
                              later.rotation = rotation_of({0.01, 0.01, 0}) * later.rotation;
                              const PoseObservation after =
                                  observe(session.truth, session.board, later, options, kind_of(pose), 99);
                              pose.in_projector = after.in_projector;
                              pose.projected = after.projected;
                            },
                            "moved"},
                    BadPose{"larger_squares",
                            [](SyntheticSession& session, const SessionOptions& options) {
                              PoseObservation& pose = session.request.poses[3].observation;
                              const std::string name = pose.name;
                              pose = observe(session.truth, session.board, session.camera_from_board[3],
                                             options, kind_of(pose), 99, 1.04);
                              pose.name = name;
                            },
                            "its squares measure 26.0"},
                    BadPose{"blurred",
                            [](SyntheticSession& session, const SessionOptions&) {
                              session.request.poses[3].edge_blur_px = 5;
                            },
                            "blurred"},
                    BadPose{"not_found",
                            [](SyntheticSession& session, const SessionOptions&) {
                              session.request.poses[3].failure =
                                  "projected board: no chessboard to be seen (too dark)";
                              session.request.poses[3].observation.in_projector.clear();
                              session.request.poses[3].observation.projected.clear();
                            },
                            "too dark"}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(CalibratingTooFew, SaysWhatIsMissingAndNamesTheBadPoses) {
  SyntheticSession session = make_session();
  session.request.poses.resize(4);
  session.request.poses[1].failure = "printed board: no chessboard to be seen";
  session.request.poses[2].failure = "projected board: no chessboard to be seen (too dark)";
  const auto result = calibrate(session.request);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::input);
  for (const char* part :
       {"at least 3 good poses", "2 are there", "pose 1: printed board", "pose 2: projected board"})
    EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
}

TEST(CalibratingAlike, ParallelBoardsAreRefusedOrFlagged) {
  SessionOptions options;
  options.largest_tilt_degrees = 0.3;
  options.distance_spread = 0.02;
  const auto result = calibrate(make_session(options).request);
  std::string told;
  if (result) {
    for (const std::string& line : result->report.advice) told += line + "\n";
  } else {
    EXPECT_NE(result.error().message.find("too much alike"), std::string::npos) << result.error().message;
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

TEST(CalibratingExtrinsics, OnePoseTellsWhereTheProjectorStands) {
  for (const PoseKind kind : {PoseKind::gray_code, PoseKind::pair}) {
    SessionOptions options;
    options.poses = 1;
    options.kind = [=](int) { return kind; };
    SyntheticSession session = make_session(options);
    Calibration old = session.truth;
    old.projector_from_camera.translation += Eigen::Vector3d(40, -25, 30);
    old.projector_from_camera.rotation =
        rotation_of({0.05, -0.08, 0.02}) * old.projector_from_camera.rotation;
    session.request.keep_intrinsics = old;
    const auto result = calibrate(session.request);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->calibration.camera.fx, old.camera.fx);
    EXPECT_EQ(result->calibration.projector.distortion, old.projector.distortion);
    EXPECT_LT((result->calibration.projector_from_camera.translation -
               session.truth.projector_from_camera.translation)
                  .norm(),
              3);
    EXPECT_FALSE(parameter(result->report, "camera fx").sigma);
    EXPECT_TRUE(parameter(result->report, "translation x").sigma);
  }
}

TEST(CalibratingRolled, FindsAProjectorOnItsSideAndUpsideDown) {
  for (const double turn : {M_PI / 2, M_PI, -M_PI / 2}) {
    SessionOptions options;
    SyntheticSession session = make_session(options);
    RigidTransform& pose = session.truth.projector_from_camera;
    pose.rotation = rotation_of({0, 0, turn}) * pose.rotation;
    pose.translation = rotation_of({0, 0, turn}) * pose.translation;
    session.truth.projector.cy = 383.5;
    for (std::size_t i = 0; i < session.request.poses.size(); ++i)
      session.request.poses[i].observation = observe(
          session.truth, session.board, session.camera_from_board[i], options, PoseKind::gray_code, 7);
    const auto result = calibrate(session.request);
    ASSERT_TRUE(result) << result.error().message;
    expect_near_truth(*result, session.truth, 1e-3);
  }
}

}  // namespace
}  // namespace bodyscan
