#include "tools/simulator/printed_sheet.hpp"

#include "tools/simulator/skin.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr PrintedBoard board{9, 7, 25};
constexpr float ink = 0.06F;
constexpr float plate = 0.7F;

TEST(PrintedSheet, SquaresAreTrueToScaleAndTheTopLeftOneIsBlack) {
  const PrintedSheet sheet(board, {});
  constexpr double hair = 1e-6;
  for (int row = 0; row <= board.rows; ++row) {
    for (int column = 0; column <= board.columns; ++column) {
      const float wanted = (row + column) % 2 == 0 ? ink : matt_albedo;
      for (const double x : {hair, 12.0, 25 - hair}) {
        for (const double y : {hair, 13.0, 25 - hair})
          ASSERT_NEAR(sheet.albedo({25 * (column - 1) + x, 25 * (row - 1) + y}), wanted, 1e-6)
              << column << ' ' << row;
      }
    }
  }
}

TEST(PrintedSheet, AWhiteMarginOfOneSquareAndThePlateSurroundTheSquares) {
  const PrintedSheet sheet(board, {.bend_mm = 0, .plate_mm = 40, .edge_mm = 0});
  EXPECT_EQ(sheet.middle(), Vector2d(100, 75));
  EXPECT_EQ(sheet.half_sheet(), Vector2d(150, 125));
  EXPECT_EQ(sheet.half_plate(), Vector2d(190, 165));
  constexpr double hair = 1e-6;
  for (const double side : {-1.0, 1.0}) {
    for (const double along : {-110.0, 0.0, 90.0}) {
      const auto across = [&](double x) { return sheet.albedo({100 + side * x, 75 + along}); };
      const auto down = [&](double y) { return sheet.albedo({100 + along, 75 + side * y}); };
      for (const double share : {hair, 12.0, 25 - hair}) {
        EXPECT_NEAR(across(125 + share), matt_albedo, 1e-6);
        EXPECT_NEAR(down(100 + share), matt_albedo, 1e-6);
      }
      EXPECT_NEAR(across(150 + hair), plate, 1e-6);
      EXPECT_NEAR(down(125 + hair), plate, 1e-6);
    }
  }
}

TEST(PrintedSheet, EdgesFadeLinearlyAroundTheirPlace) {
  const PrintedSheet sheet(board, {.bend_mm = 0, .plate_mm = 40, .edge_mm = 2});
  // Between the black square beyond corner (0, 0) and the white one right of it, at half their height.
  for (double x = -1; x <= 1; x += 0.125)
    EXPECT_NEAR(sheet.albedo({x, -12}), std::lerp(ink, matt_albedo, (x + 1) / 2), 1e-6) << x;
  for (double y = -1; y <= 1; y += 0.125)
    EXPECT_NEAR(sheet.albedo({-12, y}), std::lerp(ink, matt_albedo, (y + 1) / 2), 1e-6) << y;
  // The squares' border and the sheet's.
  EXPECT_NEAR(sheet.albedo({-25, -12}), (ink + matt_albedo) / 2, 1e-6);
  EXPECT_NEAR(sheet.albedo({-50.5, 75}), std::lerp(plate, matt_albedo, 0.25F), 1e-6);
  // Four squares meet half way.
  EXPECT_NEAR(sheet.albedo({50, 75}), (ink + matt_albedo) / 2, 1e-6);
  EXPECT_NEAR(sheet.albedo({-12, -12}), ink, 1e-6);
}

TEST(PrintedSheet, AFlatSheetIsItsOwnPlane) {
  const PrintedSheet sheet(board, {});
  EXPECT_TRUE(sheet.is_flat());
  EXPECT_EQ(sheet.point({30, -7}), Vector3d(30, -7, 0));
  EXPECT_EQ(sheet.paper({30, -7, 0}), Vector2d(30, -7));
}

TEST(PrintedSheet, BendLiesBetweenTheMiddleAndTheChordOfTheEdges) {
  for (const double bend : {12.0, -12.0, 0.3}) {
    const PrintedSheet sheet(board, {.bend_mm = bend, .plate_mm = 0, .edge_mm = 0});
    const Vector3d left = sheet.point({-50, 30});
    const Vector3d right = sheet.point({250, 30});
    EXPECT_EQ(sheet.point({100, 30}), Vector3d(100, 30, 0));
    EXPECT_NEAR(left.z(), bend, 1e-9);
    EXPECT_NEAR(right.z(), bend, 1e-9);
    EXPECT_NEAR(left.x() + right.x(), 200, 1e-9);
    EXPECT_LT(right.x() - left.x(), 300);
  }
}

TEST(PrintedSheet, BendingKeepsThePapersLengths) {
  const PrintedSheet sheet(board, {.bend_mm = 20, .plate_mm = 0, .edge_mm = 0});
  constexpr int steps = 3000;
  double length = 0;
  for (int i = 0; i < steps; ++i)
    length +=
        (sheet.point({-50 + 300.0 * (i + 1) / steps, 0}) - sheet.point({-50 + 300.0 * i / steps, 0})).norm();
  EXPECT_NEAR(length, 300, 1e-6);
  EXPECT_EQ(sheet.point({20, 60}) - sheet.point({20, 10}), Vector3d(0, 50, 0));
}

TEST(PrintedSheet, ABentSheetIsACircle) {
  const double bend = 20;
  const PrintedSheet sheet(board, {.bend_mm = bend, .plate_mm = 0, .edge_mm = 0});
  const Vector3d edge = sheet.point({250, 0});
  const double half_chord = edge.x() - 100;
  const double radius = (half_chord * half_chord + bend * bend) / (2 * bend);
  const Vector3d center(100, 0, radius);
  for (double x = -50; x <= 250; x += 10)
    EXPECT_NEAR((sheet.point({x, 0}) - center).norm(), radius, 1e-9) << x;
}

TEST(PrintedSheet, PaperAndRaysFindAPointAgain) {
  const Vector3d eye(300, -200, -900);
  for (const double bend : {0.0, 15.0, -15.0}) {
    const PrintedSheet sheet(board, {.bend_mm = bend, .plate_mm = 60, .edge_mm = 0});
    for (double x = -100; x <= 300; x += 23) {
      for (double y = -100; y <= 250; y += 29) {
        const Vector2d paper(x, y);
        const Vector3d point = sheet.point(paper);
        EXPECT_LT((sheet.paper(point) - paper).norm(), 1e-9);
        const auto hit = sheet.hit(eye, (point - eye) / 7);
        ASSERT_TRUE(hit) << bend << ": " << paper.transpose();
        EXPECT_LT((*hit - paper).norm(), 1e-6);
      }
    }
  }
}

TEST(PrintedSheet, RaysPastThePlateOrAwayFromItMiss) {
  const Vector3d eye(100, 75, -900);
  for (const double bend : {0.0, 15.0, -15.0}) {
    const PrintedSheet sheet(board, {.bend_mm = bend, .plate_mm = 60, .edge_mm = 0});
    const auto towards = [&](const Vector2d& paper) { return Vector3d(sheet.point(paper) - eye); };
    EXPECT_TRUE(sheet.hit(eye, towards({309, 75})));
    EXPECT_FALSE(sheet.hit(eye, towards({311, 75})));
    EXPECT_TRUE(sheet.hit(eye, towards({100, 259})));
    EXPECT_FALSE(sheet.hit(eye, towards({100, 261})));
    EXPECT_FALSE(sheet.hit(eye, -towards({100, 75})));
    EXPECT_FALSE(sheet.hit(eye, {1, 0.3, 0}));
  }
}

TEST(PrintedSheet, APlateBendsWithTheSheetByOneRadianAtMost) {
  const SheetForm form{.bend_mm = 30, .plate_mm = 350, .edge_mm = 0};
  const PrintedSheet sheet(board, form);
  EXPECT_EQ(sheet.half_plate().y(), 475);
  const double last = 100 + sheet.half_plate().x();
  const Vector3d step = sheet.point({last, 0}) - sheet.point({last - 1e-3, 0});
  EXPECT_NEAR(std::atan2(step.z(), step.x()), 1, 1e-5);
  EXPECT_EQ(PrintedSheet(board, {.bend_mm = 30, .plate_mm = 100, .edge_mm = 0}).half_plate().x(), 250);
}

}  // namespace
}  // namespace bodyscan::simulator
