#include "pipeline/board/gray_code_corners.hpp"

#include "pipeline/board/homography.hpp"
#include "tests/pipeline/board/synthetic_board.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace bodyscan {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

const PrintedBoard board{7, 5, 25};
const BoardView view{.picture = {300, 220}, .roll_degrees = 8, .tilt_degrees = 20};

// The camera's pixels on the board's plane to the projector's.
Matrix3d projector_from_camera() {
  Matrix3d matrix;
  matrix << 1.9, -0.25, 150,  //
      0.2, 1.6, 90,           //
      3e-4, -2e-4, 1;
  return matrix;
}

Matrix3d mirrored_projector() {
  return Eigen::DiagonalMatrix<double, 3>(-1, 1, 1) * projector_from_camera();
}

struct Decoding {
  Matrix3d projector_from_camera_px = projector_from_camera();
  double sigma_px = 0.01;
  std::function<bool(const Vector2d& px)> decided = [](const Vector2d&) { return true; };
};

struct Scene {
  ChessboardCorners corners;
  std::vector<Vector2d> truth;  // projector px
  Correspondence correspondence;
};

Scene decoded(const Decoding& how = {}) {
  const Matrix3d seen = picture_from_board(board, view);
  Scene scene{{board.columns, board.rows, {}}, {}, {view.picture, {1024, 768}, {}, {}, {}}};
  for (int i = 0; i < board.corner_count(); ++i) {
    scene.corners.corners.emplace_back(apply_homography(seen, board.corner_mm(i)));
    scene.truth.push_back(apply_homography(how.projector_from_camera_px, *scene.corners.corners.back()));
  }
  AxisCorrespondence rows{FloatImage(view.picture), FloatImage(view.picture)};
  AxisCorrespondence columns{FloatImage(view.picture), FloatImage(view.picture)};
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, how.sigma_px);
  for (int y = 0; y < view.picture.height; ++y) {
    for (int x = 0; x < view.picture.width; ++x) {
      const Vector2d at = apply_homography(how.projector_from_camera_px, Vector2d(x, y));
      const bool decided = how.decided(Vector2d(x, y));
      constexpr float undecided = std::numeric_limits<float>::quiet_NaN();
      columns.coordinate(x, y) = decided ? static_cast<float>(at.x() + noise(random)) : undecided;
      rows.coordinate(x, y) = decided ? static_cast<float>(at.y() + noise(random)) : undecided;
      columns.sigma(x, y) = rows.sigma(x, y) = static_cast<float>(how.sigma_px);
    }
  }
  scene.correspondence.rows = std::move(rows);
  scene.correspondence.columns = std::move(columns);
  return scene;
}

// Root mean square, projector px, over the corners seen.
double rms_error(const std::vector<SeenCorner>& seen, const Scene& scene) {
  double squares = 0;
  for (const SeenCorner& corner : seen)
    squares += (corner.px - scene.truth[static_cast<std::size_t>(corner.corner)]).squaredNorm();
  return std::sqrt(squares / static_cast<double>(seen.size()));
}

void expect_seen(const Scene& scene, std::size_t count, double rms) {
  const auto seen = corners_in_projector(scene.corners, scene.correspondence);
  ASSERT_TRUE(seen) << seen.error().message;
  EXPECT_EQ(seen->size(), count);
  EXPECT_LT(rms_error(*seen, scene), rms);
}

void expect_reason(const Scene& scene, const std::string& reason) {
  const auto seen = corners_in_projector(scene.corners, scene.correspondence);
  ASSERT_FALSE(seen) << seen->size() << " corners seen, expected: " << reason;
  EXPECT_EQ(seen.error().kind, ErrorKind::input);
  EXPECT_EQ(seen.error().message, reason);
}

// A place in the picture on the board, its corners at integers.
Vector2d in_squares(const Vector2d& px) {
  static const Matrix3d board_from_picture = picture_from_board(board, view).inverse();
  return apply_homography(board_from_picture, px) / board.square_mm;
}

bool on_black(const Vector2d& px) {
  const Vector2d at = in_squares(px);
  return std::lround(std::floor(at.x()) + std::floor(at.y())) % 2 == 0;
}

bool in_one_corners_quarter(const Vector2d& px) {
  const Vector2d at = in_squares(px) - Vector2d(0.25, 0.25);
  return (at - Vector2d(std::round(at.x()), std::round(at.y()))).norm() < 0.18;
}

TEST(GrayCodeCorners, ExactOnAPlane) {
  expect_seen(decoded({.sigma_px = 0}), 35, 1e-4);
}

// About 650 pixels a corner: the mean is some 25 times as good as one of them, times two for the slopes.
TEST(GrayCodeCorners, NoiseIsAveraged) {
  expect_seen(decoded({.sigma_px = 0.3}), 35, 0.04);
}

TEST(GrayCodeCorners, UndecidedPixelsAreLeftOut) {
  std::mt19937 random(2);
  std::bernoulli_distribution decided(0.3);
  expect_seen(decoded({.sigma_px = 0.1, .decided = [&](const Vector2d&) { return decided(random); }}), 35,
              0.03);
}

TEST(GrayCodeCorners, TheWhiteSquaresSuffice) {
  expect_seen(decoded({.sigma_px = 0.1, .decided = [](const Vector2d& px) { return !on_black(px); }}), 35,
              0.03);
}

TEST(GrayCodeCorners, PixelsOffThePlaneAreDropped) {
  Scene scene = decoded({.sigma_px = 0.05});
  std::mt19937 random(3);
  std::bernoulli_distribution wrong(0.05);
  for (float& column : scene.correspondence.columns->coordinate.pixels())
    if (wrong(random)) column += 16;  // a bit decided wrongly
  expect_seen(scene, 35, 0.01);
}

TEST(GrayCodeCorners, UncertainPixelsCountLittle) {
  Scene scene = decoded({.sigma_px = 0.05});
  for (int y = 0; y < view.picture.height; ++y) {
    for (int x = y % 2; x < view.picture.width; x += 2) {
      scene.correspondence.rows->coordinate(x, y) += 0.15F;
      scene.correspondence.rows->sigma(x, y) = 0.5F;
    }
  }
  expect_seen(scene, 35, 0.015);
}

TEST(GrayCodeCorners, CornersThatTheCameraMissedAreMissing) {
  Scene scene = decoded();
  scene.corners.corners[0].reset();
  scene.corners.corners[17].reset();
  const auto seen = corners_in_projector(scene.corners, scene.correspondence);
  ASSERT_TRUE(seen) << seen.error().message;
  EXPECT_EQ(seen->size(), 33U);
  for (const SeenCorner& corner : *seen) EXPECT_TRUE(corner.corner != 0 && corner.corner != 17);
  EXPECT_LT(rms_error(*seen, scene), 0.01);
}

TEST(GrayCodeCorners, ThoseWithoutDecodedPixelsAreLeftOut) {
  const Scene dark = decoded();
  const double left = dark.corners.at(1, 2)->x() + 10;  // about the first two columns
  const Scene scene = decoded({.decided = [&](const Vector2d& px) { return px.x() > left + 16; }});
  const auto seen = corners_in_projector(scene.corners, scene.correspondence);
  ASSERT_TRUE(seen) << seen.error().message;
  EXPECT_LT(seen->size(), 30U);
  EXPECT_GE(seen->size(), 21U);
  for (const SeenCorner& corner : *seen) EXPECT_GE(corner.corner % board.columns, 1);
  EXPECT_LT(rms_error(*seen, scene), 0.05);
}

// A corner would have to be extrapolated.
TEST(GrayCodeCorners, AQuarterOfTheSurroundingsIsTooLittle) {
  expect_reason(decoded({.decided = in_one_corners_quarter}),
                "the projector's stripes are decoded at 0 of 35 printed corners: too dark, or not lit");
}

TEST(GrayCodeCorners, TooFewAreDecoded) {
  const Scene all = decoded();
  const double middle = all.corners.at(3, 2)->x();
  expect_reason(decoded({.decided = [](const Vector2d&) { return false; }}),
                "the projector's stripes are decoded at 0 of 35 printed corners: too dark, or not lit");
  const auto half = corners_in_projector(
      all.corners,
      decoded({.decided = [&](const Vector2d& px) { return px.x() > middle + 10; }}).correspondence);
  ASSERT_FALSE(half);
  EXPECT_NE(half.error().message.find("of 35 printed corners: too dark, or not lit"), std::string::npos)
      << half.error().message;
}

TEST(GrayCodeCorners, AHandfulOfPixelsIsTooFew) {
  const auto sparse = [](int step) {
    return decoded({.decided = [=](const Vector2d& px) {
      return static_cast<int>(px.x()) % step == 0 && static_cast<int>(px.y()) % step == 0;
    }});
  };
  expect_seen(sparse(4), 35, 0.02);
  expect_reason(sparse(8),
                "the projector's stripes are decoded at 0 of 35 printed corners: too dark, or not lit");
}

TEST(GrayCodeCorners, MirroredPicturesAreRefused) {
  const std::string reason =
      "the pictures are mirrored: left and right are swapped between camera and projector";
  expect_reason(decoded({.projector_from_camera_px = mirrored_projector(), .sigma_px = 0.3}), reason);
}

TEST(GrayCodeCorners, AProjectorOnItsSideOrUpsideDownIsNotMirrored) {
  for (const double turn : {M_PI / 2, M_PI, -M_PI / 2}) {
    Matrix3d turned = Matrix3d::Identity();
    turned.topLeftCorner<2, 2>() << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
    expect_seen(decoded({.projector_from_camera_px = turned * projector_from_camera()}), 35, 0.01);
  }
}

TEST(GrayCodeCorners, BothDirectionsAreNeeded) {
  const std::string reason = "a calibration needs stripes along rows and columns";
  Scene scene = decoded();
  scene.correspondence.rows.reset();
  expect_reason(scene, reason);
  scene = decoded();
  scene.correspondence.columns.reset();
  expect_reason(scene, reason);
}

}  // namespace
}  // namespace bodyscan
