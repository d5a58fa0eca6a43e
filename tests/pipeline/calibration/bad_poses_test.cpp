#include "pipeline/calibration/rig_model.hpp"
#include "tests/pipeline/calibration/synthetic_session.hpp"

#include <map>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

TEST(BadCorners, FalseCornersAreLeftOut) {
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

SessionOptions session_of(PoseKind kind) {
  SessionOptions options;
  options.poses = 6;
  options.kind = [=](int) { return kind; };
  return options;
}

// Of a session without a bad pose.
double clean_rms(PoseKind kind) {
  static std::map<PoseKind, double> known;
  const auto found = known.find(kind);
  if (found != known.end()) return found->second;
  return known[kind] = calibrate(make_session(session_of(kind)).request).value().report.joint_rms_px;
}

TEST_P(Spoilt, PoseIsNamedAndLeftOut) {
  for (const PoseKind kind : {PoseKind::gray_code, PoseKind::pair}) {
    const SessionOptions options = session_of(kind);
    SyntheticSession session = make_session(options);
    GetParam().spoil(session, options);
    const auto result = calibrate(session.request);
    ASSERT_TRUE(result) << result.error().message;
    for (std::size_t i = 0; i < result->report.poses.size(); ++i)
      EXPECT_EQ(result->report.poses[i].used, i != 3) << i << ": " << result->report.poses[i].reason;
    EXPECT_NE(result->report.poses[3].reason.find(GetParam().reason), std::string::npos)
        << result->report.poses[3].reason;
    EXPECT_LT(result->report.joint_rms_px, 1.2 * clean_rms(kind));
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

TEST(TooFewPoses, SaysWhatIsMissingAndNamesTheBadPoses) {
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

// The projector showed something else: hundreds of pixels must not draw the first fit to themselves.
TEST(BadPoses, OneThatIsFarOffDoesNotSpoilTheRest) {
  SessionOptions options;
  options.kind = [](int) { return PoseKind::pair; };
  SyntheticSession session = make_session(options);
  PoseObservation& pose = session.request.poses[3].observation;
  for (std::size_t i = 0; i < pose.projected.size(); ++i)
    pose.projected[i].camera_px = pose.in_camera[i].px + Eigen::Vector2d(3, 2);
  const auto result = calibrate(session.request);
  ASSERT_TRUE(result) << result.error().message;
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(result->report.poses[i].used, i != 3) << i;
  expect_near_truth(*result, session.truth, 1e-3);
  EXPECT_TRUE(result->report.poses[3].located);
  EXPECT_GT(result->report.poses[3].projector_rms_px, 5);
}

TEST(BadPoses, OneOfThreeIsNoticed) {
  for (const PoseKind kind : {PoseKind::gray_code, PoseKind::pair}) {
    SessionOptions options;
    options.poses = 3;
    options.kind = [=](int) { return kind; };
    SyntheticSession session = make_session(options);
    ASSERT_TRUE(calibrate(session.request));
    RigidTransform later = session.camera_from_board[1];
    later.translation += Eigen::Vector3d(1, -2, 4);
    later.rotation = rotation_of({0.01, 0.01, 0}) * later.rotation;
    const PoseObservation after = observe(session.truth, session.board, later, options, kind, 99);
    session.request.poses[1].observation.in_projector = after.in_projector;
    session.request.poses[1].observation.projected = after.projected;
    const auto result = calibrate(session.request);
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("contradict"), std::string::npos) << result.error().message;
  }
}

TEST(BadPoses, WithoutAPictureOfTheBoardHaveNoFigures) {
  SyntheticSession session = make_session();
  session.request.poses[2].failure = "printed board: no chessboard to be seen";
  session.request.poses[2].observation.in_camera.clear();
  session.request.poses[2].observation.in_projector.clear();
  const auto result = calibrate(session.request);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_FALSE(result->report.poses[2].located);
  EXPECT_TRUE(result->report.poses[1].located);
}

// Shot again and again, a board that is not moved tells what one pose tells.
TEST(BadPoses, TheSamePoseThreeTimesIsOne) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    SessionOptions options;
    options.poses = 3;
    SyntheticSession session = make_session(options);
    for (unsigned i = 1; i < 3; ++i) {
      PoseObservation& pose = session.request.poses[i].observation;
      const std::string name = pose.name;
      pose = observe(session.truth, session.board, session.camera_from_board[0], options, PoseKind::gray_code,
                     10 * seed + i);
      pose.name = name;
    }
    const auto result = calibrate(session.request);
    ASSERT_FALSE(result);
    for (const char* part : {"at least 3 good poses", "pose 2: nearly parallel to pose 0"})
      EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
  }
}

TEST(BadPoses, AnotherProjectedBoardThanTheSessionSaysIsRefused) {
  SessionOptions options;
  options.poses = 6;
  options.kind = [](int i) { return i < 3 ? PoseKind::gray_code : PoseKind::pair; };
  SyntheticSession session = make_session(options);
  const Eigen::Vector2d first = options.projected.first_corner_px;
  for (CalibrationPose& pose : session.request.poses)
    for (Beam& beam : pose.observation.projected)
      beam.projector_px = first + 1.05 * (beam.projector_px - first);
  const auto result = calibrate(session.request);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("projected"), std::string::npos) << result.error().message;
}

}  // namespace
}  // namespace bodyscan
