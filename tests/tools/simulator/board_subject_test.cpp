#include "tests/tools/simulator/session_test_support.hpp"
#include "tools/simulator/pose_camera.hpp"
#include "tools/simulator/subjects.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr PrintedBoard board{9, 7, 25};
constexpr double degree = std::numbers::pi / 180;
constexpr double ray_mm = 1000.0 / 900 / 4;  // 1 m away, of four rays a pixel

TEST(BoardSubject, IsTheWholePlateSeenFromItsFront) {
  for (const double bend : {0.0, 15.0, -15.0}) {
    const PrintedSheet sheet(board, {.bend_mm = bend, .plate_mm = 50, .edge_mm = 0});
    const Subject subject = make_printed_board(sheet);
    EXPECT_EQ(subject.material, Material::printed);
    ASSERT_TRUE(subject.sheet);
    Eigen::AlignedBox2d paper;
    for (const Vector3d& point : subject.mesh.points) paper.extend(sheet.paper(point));
    EXPECT_LT((paper.min() - Vector2d(-100, -100)).norm(), 1e-6) << bend;
    EXPECT_LT((paper.max() - Vector2d(300, 250)).norm(), 1e-6) << bend;
    for (const Triangle& triangle : subject.mesh.triangles) {
      const Vector3d& a = subject.mesh.points[triangle[0]];
      const Vector3d& b = subject.mesh.points[triangle[1]];
      const Vector3d& c = subject.mesh.points[triangle[2]];
      EXPECT_LT((b - a).cross(c - a).z(), 0);
      const Vector3d middle = (a + b + c) / 3;
      EXPECT_LT((sheet.point(sheet.paper(middle)) - middle).norm(), 0.0004);
    }
  }
}

// A pinhole, and a projector beside it that lights all that the pinhole sees.
Calibration pinhole_rig() {
  Calibration rig;
  rig.camera = {.size = {400, 300}, .fx = 900, .fy = 850, .cx = 197.3, .cy = 152.6, .distortion = {}};
  rig.projector = {.size = {512, 384}, .fx = 400, .fy = 400, .cx = 255.5, .cy = 191.5, .distortion = {}};
  rig.projector_from_camera.translation = {100, 60, 0};
  return rig;
}

RigidTransform tilted() {
  RigidTransform pose;
  pose.rotation =
      (Eigen::AngleAxisd(20 * degree, Vector3d::UnitX()) *
       Eigen::AngleAxisd(-17 * degree, Vector3d::UnitY()) * Eigen::AngleAxisd(8 * degree, Vector3d::UnitZ()))
          .toRotationMatrix();
  pose.translation = Vector3d(-90, -80, 1000);
  return pose;
}

ColorImage8 picture_of(const PrintedSheet& sheet, const RigidTransform& camera_from_board,
                       RenderOptions options) {
  options.full_well = 0;
  const SessionPose pose{false, sheet, camera_from_board, camera_from_board, options.light, options.light,
                         0.7,   {}};
  return PoseCamera::make(pinhole_rig(), pose, 0, options)->take(Pattern{.kind = PatternKind::white}, 0);
}

// A place on a sheet that is flat, or on a circle's arc of `radius` behind or before its middle.
Vector3d on_sheet(const Vector2d& paper, double radius) {
  if (radius == 0) return {paper.x(), paper.y(), 0};
  const double angle = (paper.x() - 100) / radius;
  return {100 + radius * std::sin(angle), paper.y(), radius * (1 - std::cos(angle))};
}

double bend_of(double radius) {
  return radius == 0 ? 0 : radius * (1 - std::cos(150 / radius));
}

Vector2d pinhole_pixel(const Vector3d& point) {
  return {900 * point.x() / point.z() + 197.3, 850 * point.y() / point.z() + 152.6};
}

class RenderedBoard : public testing::TestWithParam<double> {};  // the bend's radius, mm; 0: flat

TEST_P(RenderedBoard, HasItsEdgesWhereThePinholeSeesThem) {
  const double radius = GetParam();
  const PrintedSheet sheet(board, {.bend_mm = bend_of(radius), .plate_mm = 0, .edge_mm = ray_mm});
  const RigidTransform pose = tilted();
  RenderOptions options = even_light(session_render_defaults());
  options.rays = 4;
  const ColorImage8 picture = picture_of(sheet, pose, options);
  const double error = largest_edge_error(
      9, 7, [&](int x, int y) { return green_light(picture, x, y); },
      [&](double column, double row) {
        return pinhole_pixel(pose * on_sheet({25 * column, 25 * row}, radius));
      });
  EXPECT_LT(error, 0.05);
}

TEST_P(RenderedBoard, HasItsColoursInTheMiddleOfItsSquares) {
  const double radius = GetParam();
  const PrintedSheet sheet(board, {.bend_mm = bend_of(radius), .plate_mm = 0, .edge_mm = ray_mm});
  const RigidTransform pose = tilted();
  const ColorImage8 picture = picture_of(sheet, pose, session_render_defaults());
  for (int row = -1; row <= 8; ++row) {
    for (int column = -1; column <= 10; ++column) {
      const bool margin = row < 0 || column < 0 || row > 7 || column > 9;
      const bool black = !margin && (row + column) % 2 == 0;
      const Vector2d pixel = pinhole_pixel(pose * on_sheet({25 * (column - 0.5), 25 * (row - 0.5)}, radius));
      const double light = green_light(picture, static_cast<int>(std::lround(pixel.x())),
                                       static_cast<int>(std::lround(pixel.y())));
      EXPECT_EQ(light < 0.1, black) << column << ' ' << row;
      EXPECT_EQ(light > 0.3, !black) << column << ' ' << row;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(FlatAndBent, RenderedBoard, testing::Values(0.0, 800.0, -800.0));

TEST(RenderedBoard, LeavesWhitePaperBelowFullScaleAtTheNearestStand) {
  const PrintedSheet sheet(board, {.bend_mm = 0, .plate_mm = 0, .edge_mm = ray_mm});
  RigidTransform pose;
  pose.translation = {-100, -75, 900};
  const ColorImage8 picture = picture_of(sheet, pose, session_render_defaults());
  int brightest = 0;
  for (const Rgb8& pixel : picture.pixels()) brightest = std::max<int>(brightest, pixel[1]);
  EXPECT_LT(brightest, 250);
  EXPECT_GT(brightest, 200);
}

}  // namespace
}  // namespace bodyscan::simulator
