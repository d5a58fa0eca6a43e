#include "tools/simulator/rig.hpp"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

using Eigen::Vector3d;

Calibration rig(const std::string& name, double roll, double scale = 0.5) {
  return make_rig({.name = name, .scale = scale, .projector = {1024, 768}, .projector_roll = roll}).value();
}

Vector3d projector_position(const Calibration& calibration) {
  const RigidTransform& transform = calibration.projector_from_camera;
  return -(transform.rotation.transpose() * transform.translation);
}

TEST(Rig, AimsThePictureCenterAtTheReferencePointAtAnyRoll) {
  for (const char* name : {"rows", "columns", "diagonal"}) {
    for (const double roll : {0.0, 30.0, 90.0, 180.0, -45.0}) {
      const Calibration calibration = rig(name, roll);
      const Vector3d seen = calibration.projector_from_camera * Vector3d(0, 0, 1050);
      EXPECT_LT((calibration.projector.project(seen) - Eigen::Vector2d(511.5, 383.5)).norm(), 1e-6)
          << name << roll;
      EXPECT_NEAR(calibration.projector_from_camera.rotation.determinant(), 1, 1e-12);
    }
  }
}

TEST(Rig, StandsWhereTheDepthCarryingAxisNeedsIt) {
  EXPECT_LT((projector_position(rig("rows", 0)) - Vector3d(0, 268, 0)).norm(), 1e-9);
  EXPECT_LT((projector_position(rig("rows", 30)) - Vector3d(0, 268, 0)).norm(), 1e-9);
  EXPECT_LT((projector_position(rig("rows", 180)) - Vector3d(0, 268, 0)).norm(), 1e-9);
  EXPECT_LT((projector_position(rig("rows", 90)) - Vector3d(272, 0, 0)).norm(), 1e-9);
  EXPECT_LT((projector_position(rig("columns", 0)) - Vector3d(272, 0, 0)).norm(), 1e-9);
  EXPECT_LT((projector_position(rig("columns", 90)) - Vector3d(0, 268, 0)).norm(), 1e-9);
}

TEST(Rig, DepthMovesAPointAlongTheNamedAxis) {
  const auto shift = [](const Calibration& calibration) {
    const auto pixel = [&](double z) {
      return calibration.projector.project(calibration.projector_from_camera * Vector3d(0, 0, z));
    };
    return Eigen::Vector2d(pixel(1060) - pixel(1050));
  };
  for (const double roll : {0.0, 180.0, 90.0, 270.0}) {
    EXPECT_GT(std::abs(shift(rig("rows", roll)).y()), 3) << roll;
    EXPECT_LT(std::abs(shift(rig("rows", roll)).x()), 0.5) << roll;
    EXPECT_GT(std::abs(shift(rig("columns", roll)).x()), 3) << roll;
  }
  EXPECT_GT(std::abs(shift(rig("rows", 30)).y()), 2.5);
}

TEST(Rig, ScalesTheCameraAboutItsPictureNotItsFirstPixel) {
  const Calibration full = rig("rows", 0, 1);
  const Calibration half = rig("rows", 0, 0.5);
  EXPECT_EQ(full.camera.size, (Size{4288, 2848}));
  EXPECT_EQ(half.camera.size, (Size{2144, 1424}));
  const Vector3d point(120, -80, 1000);
  const Eigen::Vector2d a = full.camera.project(point);
  const Eigen::Vector2d b = half.camera.project(point);
  EXPECT_LT(((a.array() + 0.5) / 2 - 0.5 - b.array()).matrix().norm(), 1e-9);
}

TEST(Rig, NamesTheWrongOption) {
  EXPECT_NE(make_rig({.name = "left", .scale = 1, .projector = {1024, 768}, .projector_roll = 0})
                .error()
                .message.find("\"left\""),
            std::string::npos);
  EXPECT_TRUE(make_rig({.name = "rows", .scale = std::nan(""), .projector = {1024, 768}, .projector_roll = 0})
                  .error()
                  .message.starts_with("--scale"));
  EXPECT_TRUE(make_rig({.name = "rows", .scale = 1, .projector = {0, 0}, .projector_roll = 0})
                  .error()
                  .message.starts_with("--projector:"));
}

}  // namespace
}  // namespace bodyscan::simulator
