#include "pipeline/calibration/square_check.hpp"

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

TEST(SideFigures, AreMeanAndStandardDeviationInPercent) {
  const SideFigures figures = figures_of({1.01, 1.03});
  EXPECT_NEAR(figures.error_percent.value(), 2, 1e-9);
  EXPECT_NEAR(figures.spread_percent.value(), 1, 1e-9);
}

TEST(SideFigures, AreNotThereOfNoSides) {
  EXPECT_FALSE(figures_of({}).error_percent);
  EXPECT_FALSE(figures_of({}).spread_percent);
}

// No corner is seen by both devices.
TEST(TriangulatedBoard, HasNoSidesWhereNoCornerIsSeenTwice) {
  Calibration calibration;
  calibration.camera = {.size = {640, 480}, .fx = 600, .fy = 600, .cx = 320, .cy = 240, .distortion = {}};
  calibration.projector = calibration.camera;
  calibration.projector_from_camera.translation = {100, 0, 0};
  PoseObservation pose;
  pose.in_camera = {{0, {300, 200}}, {1, {330, 200}}};
  pose.in_projector = {{3, {300, 230}}};
  EXPECT_TRUE(triangulate_board(calibration, {.columns = 3, .rows = 3, .square_mm = 25}, pose).sides.empty());
}

}  // namespace
}  // namespace bodyscan
