#include "tools/simulator/session_poses.hpp"

#include "tests/tools/simulator/session_test_support.hpp"
#include "tools/simulator/projected_chessboard.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double degree = std::numbers::pi / 180;

SessionOptions long_session(SessionMethod method, const std::string& rig) {
  SessionOptions options = small_session(method);
  options.render.calibration = "builtin:" + rig;
  options.poses = most_session_poses;
  return options;
}

// The sheet's corners and the middles of its sides, in the camera frame.
std::vector<Vector3d> outline(const SessionPose& pose) {
  std::vector<Vector3d> points;
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      const Vector2d way = pose.sheet.half_sheet().cwiseProduct(Vector2d(x, y));
      points.push_back(pose.first_camera_from_board * pose.sheet.point(pose.sheet.middle() + way));
    }
  }
  return points;
}

bool inside(const Lens& lens, const Vector3d& point) {
  const Vector2d pixel = lens.project(point);
  return point.z() > 0 && (pixel.array() >= 0).all() && pixel.x() <= lens.size.width - 1 &&
         pixel.y() <= lens.size.height - 1;
}

bool both_see(const Calibration& rig, const SessionPose& pose) {
  const std::vector<Vector3d> points = outline(pose);
  return std::all_of(points.begin(), points.end(), [&](const Vector3d& point) {
    return inside(rig.camera, point) && inside(rig.projector, rig.projector_from_camera * point);
  });
}

TEST(SessionPoses, CameraAndProjectorSeeTheWholeSheetFromTheFront) {
  for (const char* name : {"rows", "columns", "diagonal"}) {
    for (const double bend : {0.0, 10.0}) {
      SessionOptions options = long_session(SessionMethod::mixed, name);
      options.bend_mm = bend;
      const Expected<SessionTruth> truth = plan_session(options);
      ASSERT_TRUE(truth) << truth.error().message;
      ASSERT_EQ(truth->poses.size(), 14U);
      const RigidTransform& rig = truth->calibration.projector_from_camera;
      const Vector3d projector = -(rig.rotation.transpose() * rig.translation);
      for (const SessionPose& pose : truth->poses) {
        EXPECT_TRUE(both_see(truth->calibration, pose));
        const Vector3d front = -pose.first_camera_from_board.rotation.col(2);
        for (const Vector3d& point : outline(pose)) {
          EXPECT_GT(front.dot(-point.normalized()), 0.3);
          EXPECT_GT(front.dot((projector - point).normalized()), 0.3);
        }
      }
    }
  }
}

TEST(SessionPoses, SheetsStandAtTheirDistanceAndTilt) {
  const SessionTruth truth = plan_session(long_session(SessionMethod::gray, "diagonal")).value();
  for (const SessionPose& pose : truth.poses) {
    const RigidTransform& transform = pose.first_camera_from_board;
    EXPECT_NEAR(transform.rotation.determinant(), 1, 1e-9);
    const double distance = (transform * pose.sheet.point(pose.sheet.middle())).z();
    EXPECT_GE(distance, 900);
    EXPECT_LE(distance, 1200);
    const Vector3d away = transform.rotation.col(2);
    EXPECT_LE(std::atan2(std::abs(away.y()), away.z()), 35 * degree + 1e-9);
    EXPECT_LE(std::asin(std::abs(away.x())), 35 * degree + 1e-9);
    EXPECT_GT(transform.rotation(0, 0), std::cos(35 * degree) * std::cos(20 * degree) - 0.05);
  }
  const RigidTransform& first = truth.poses[0].first_camera_from_board;  // pitch 22, yaw 8, no roll
  EXPECT_LT((first.rotation - (Eigen::AngleAxisd(22 * degree, Vector3d::UnitX()) *
                               Eigen::AngleAxisd(8 * degree, Vector3d::UnitY()))
                                  .toRotationMatrix())
                .norm(),
            1e-9);
}

TEST(SessionPoses, EverySevenTiltToAllFourSidesAndReachAllBorders) {
  const SessionTruth truth = plan_session(long_session(SessionMethod::gray, "rows")).value();
  for (const int first : {0, 7}) {
    Vector2d least_tilt(0, 0);
    Vector2d most_tilt(0, 0);
    Vector2d least(1, 1);
    Vector2d most(0, 0);
    for (int i = first; i < first + 7; ++i) {
      const SessionPose& pose = truth.poses[static_cast<std::size_t>(i)];
      const Vector2d away = pose.first_camera_from_board.rotation.col(2).head<2>();
      least_tilt = least_tilt.cwiseMin(away);
      most_tilt = most_tilt.cwiseMax(away);
      for (const Vector3d& point : outline(pose)) {
        const Size size = truth.calibration.camera.size;
        const Vector2d share =
            truth.calibration.camera.project(point).cwiseQuotient(Vector2d(size.width, size.height));
        least = least.cwiseMin(share);
        most = most.cwiseMax(share);
      }
    }
    EXPECT_LT(least_tilt.maxCoeff(), -std::sin(20 * degree));
    EXPECT_GT(most_tilt.minCoeff(), std::sin(20 * degree));
    EXPECT_LT(least.maxCoeff(), 0.05);
    EXPECT_GT(most.minCoeff(), 0.95);
  }
}

TEST(SessionPoses, ASheetOnItsWayToACornerCannotGoFarther) {
  struct Way {
    std::size_t pose;
    double right, down;
  };
  for (const PrintedBoard& board : {PrintedBoard{9, 7, 25}, PrintedBoard{15, 3, 25}}) {
    SessionOptions options = long_session(SessionMethod::gray, "rows");
    options.board = board;
    const SessionTruth truth = plan_session(options).value();
    for (const auto& [index, right, down] :
         {Way{1, -1, -1}, {2, 1, 1}, {3, 1, -1}, {4, -1, 1}, {9, 1, -1}, {10, -1, 1}}) {
      for (const Vector3d& step : {Vector3d(right * 15, 0, 0), Vector3d(0, down * 15, 0)}) {
        SessionPose farther = truth.poses[index];
        farther.first_camera_from_board.translation += step;
        EXPECT_FALSE(both_see(truth.calibration, farther)) << index << ": " << step.transpose();
      }
    }
  }
}

TEST(SessionPoses, BeforeBlundersBothPicturesShowTheSame) {
  const SessionOptions options = long_session(SessionMethod::mixed, "diagonal");
  const SessionTruth truth = plan_session(options).value();
  for (std::size_t i = 0; i < truth.poses.size(); ++i) {
    const SessionPose& pose = truth.poses[i];
    EXPECT_EQ(pose.gray, i % 2 == 1);
    EXPECT_EQ(pose.second_camera_from_board.rotation, pose.first_camera_from_board.rotation);
    EXPECT_EQ(pose.second_camera_from_board.translation, pose.first_camera_from_board.translation);
    EXPECT_EQ(pose.first_light, options.render.light);
    EXPECT_EQ(pose.second_light, options.render.light);
    EXPECT_EQ(pose.lens_blur, options.render.lens_blur);
    EXPECT_TRUE(pose.blunders.empty());
    EXPECT_EQ(pose.sheet.form().plate_mm, pose.gray ? 0 : 350);
    const double ray_mm = 1 / truth.calibration.camera.fx / options.render.rays;
    EXPECT_NEAR(pose.sheet.form().edge_mm / ray_mm,
                (pose.first_camera_from_board * pose.sheet.point(pose.sheet.middle())).z(), 1e-6);
  }
}

TEST(ProjectedCorners, LieOnTheSheetWhereTheProjectorsPixelsFallAndTheCameraSeesThem) {
  for (const char* name : {"rows", "columns", "diagonal"}) {
    for (const double bend : {0.0, 10.0}) {
      SessionOptions options = long_session(SessionMethod::projected, name);
      options.bend_mm = bend;
      const SessionTruth truth = plan_session(options).value();
      const Calibration& rig = truth.calibration;
      for (const SessionPose& pose : truth.poses) {
        const RigidTransform& camera_from_board = pose.second_camera_from_board;
        const auto corners = projected_corners(rig, truth.projected, pose.sheet, camera_from_board);
        ASSERT_EQ(corners.size(), 63U);
        for (int i = 0; i < truth.projected.corner_count(); ++i) {
          const Vector3d& corner = corners[static_cast<std::size_t>(i)];
          EXPECT_TRUE(inside(rig.camera, corner));
          const Vector2d pixel = rig.projector.project(rig.projector_from_camera * corner);
          EXPECT_LT((pixel - truth.projected.corner_px(i)).norm(), 1e-6);
          const Vector3d on_board =
              camera_from_board.rotation.transpose() * (corner - camera_from_board.translation);
          EXPECT_LT((pose.sheet.point(pose.sheet.paper(on_board)) - on_board).norm(), 1e-6);
        }
      }
    }
  }
}

TEST(ProjectedCorners, AreNoneWhereOneMissesThePlate) {
  const SessionOptions options = small_session(SessionMethod::projected);
  const SessionTruth truth = plan_session(options).value();
  const SessionPose& pose = truth.poses[0];
  const PrintedSheet small(options.board, {.bend_mm = 0, .plate_mm = 0, .edge_mm = 0});
  const ProjectedBoard wide = fit_projected_board(options.render.rig.projector, 9, 7, 1);
  EXPECT_FALSE(projected_corners(truth.calibration, truth.projected, pose.sheet, pose.first_camera_from_board)
                   .empty());
  EXPECT_TRUE(projected_corners(truth.calibration, wide, small, pose.first_camera_from_board).empty());
}

TEST(ProjectedBoard, SpansItsShareOrWhatTheCameraSees) {
  SessionOptions options = small_session(SessionMethod::projected);
  options.projected_share = 0.2;
  const ProjectedBoard small = plan_session(options).value().projected;
  EXPECT_EQ(small.columns, 9);
  EXPECT_EQ(small.rows, 7);
  EXPECT_EQ(small.square_px, 4);  // 0.2 of 192 rows for 8 squares
  options.projected_share = 1;
  const ProjectedBoard large = plan_session(options).value().projected;
  EXPECT_GT(large.square_px, 8);
  EXPECT_LT(large.square_px, 24);
}

TEST(ProjectedBoard, TheSmallestShareIsTried) {
  SessionOptions options = small_session(SessionMethod::projected);
  options.projected_share = smallest_projected_share;
  EXPECT_EQ(plan_session(options).value().projected.square_px, 2);
}

TEST(SessionPoses, WhatCannotBeSeenIsAnErrorThatNamesTheOptions) {
  const std::vector<std::pair<std::string, std::function<void(SessionOptions&)>>> cases{
      {"--columns, --rows, --square-mm: camera and projector do not both see the whole board of pose 0",
       [](SessionOptions& o) {
         o.board.square_mm = 60;
         o.method = SessionMethod::gray;
       }},
      {"--plate, --projector: the camera does not see a whole projected board",
       [](SessionOptions& o) {
         o.render.rig.projector = {16, 16};
       }},
  };
  for (const auto& [wanted, spoil] : cases) {
    SessionOptions options = small_session(SessionMethod::projected);
    spoil(options);
    const Expected<SessionTruth> truth = plan_session(options);
    ASSERT_FALSE(truth) << wanted;
    EXPECT_EQ(truth.error().kind, ErrorKind::usage);
    EXPECT_TRUE(truth.error().message.starts_with(wanted)) << truth.error().message;
  }
}

}  // namespace
}  // namespace bodyscan::simulator
