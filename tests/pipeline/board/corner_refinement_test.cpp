#include "pipeline/board/corner_refinement.hpp"

#include "tests/pipeline/board/synthetic_board.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

const PrintedBoard board{5, 4, 25};

struct Picture {
  FloatImage image;
  std::vector<Vector2d> truth;
};

Picture pictured(const BoardView& view, const BoardPicture& how = {}) {
  Photograph photo = photograph(board, picture_from_board(board, view), view.picture, how);
  Picture result{FloatImage(view.picture), std::move(photo.printed)};
  std::ranges::copy(photo.picture.pixels(), result.image.data());
  return result;
}

const BoardView rolled{.picture = {240, 200}, .roll_degrees = 12};

TEST(RefiningACorner, WalksToItFromNearby) {
  const auto [image, truth] = pictured(rolled);
  for (const Vector2d& off : {Vector2d(0, 0), Vector2d(1.5, -1), Vector2d(-2, 1.5)}) {
    for (const Vector2d& corner : truth) {
      const auto refined = refine_corner(image, nullptr, corner + off, 5);
      ASSERT_TRUE(refined) << off.transpose();
      EXPECT_LT((*refined - corner).norm(), 0.1) << off.transpose();
    }
  }
}

TEST(RefiningACorner, NothingFarFromOne) {
  const auto [image, truth] = pictured(rolled);
  const Vector2d along = truth[1] - truth[0];
  const Vector2d down = truth[5] - truth[0];
  EXPECT_FALSE(refine_corner(image, nullptr, truth[0] + along / 2 + down / 2, 5)) << "inside a square";
  EXPECT_FALSE(refine_corner(image, nullptr, truth[0] + along / 2, 5)) << "on an edge";
  EXPECT_FALSE(refine_corner(image, nullptr, truth[0] + along / 5, 5)) << "runs away";
}

TEST(RefiningACorner, NothingAtTheBorder) {
  const auto [image, truth] = pictured(rolled);
  for (const Vector2d& at : {Vector2d(0, 0), Vector2d(6, 100), Vector2d(120, 194), Vector2d(-5, 500)})
    EXPECT_FALSE(refine_corner(image, nullptr, at, 5)) << at.transpose();
}

// Left and right of the corner something else is seen, and the weight says so.
TEST(RefiningACorner, WeighsPixels) {
  auto [image, truth] = pictured(rolled);
  const Vector2d corner = truth[7];
  FloatImage weight(image.size(), 1);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const double distance = std::abs(x - corner.x());
      if (distance > 5) image(x, y) = y % 4 < 2 ? 0.0F : 255.0F;
      if (distance > 3) weight(x, y) = 0;  // gradients reach two pixels over
    }
  }
  const auto unweighted = refine_corner(image, nullptr, corner, 6);
  EXPECT_TRUE(!unweighted || (*unweighted - corner).norm() > 0.3);
  const auto weighted = refine_corner(image, &weight, corner, 6);
  ASSERT_TRUE(weighted);
  EXPECT_LT((*weighted - corner).norm(), 0.1);
}

TEST(RefiningCorners, LeavesOutThoseThatDoNotHold) {
  auto [image, truth] = pictured(rolled);
  ChessboardCorners rough{5, 4, {truth.begin(), truth.end()}};
  rough.corners[3].reset();
  const Vector2d covered = truth[12];
  for (int y = -14; y <= 14; ++y)
    for (int x = -14; x <= 14; ++x)
      image(static_cast<int>(covered.x()) + x, static_cast<int>(covered.y()) + y) = 99;
  const ChessboardCorners refined = refine_corners(image, nullptr, rough);
  EXPECT_EQ(refined.found(), 18);
  EXPECT_FALSE(refined.corners[3]);
  EXPECT_FALSE(refined.corners[12]);
  EXPECT_LT(compare(refined, truth).worst, 0.1);
}

TEST(EdgeBlur, GrowsWithThePictures) {
  for (const double blur : {1.0, 2.0, 3.0}) {
    const auto [image, truth] = pictured(rolled, {.blur_px = blur});
    const double measured = edge_blur_px(image, {5, 4, {truth.begin(), truth.end()}});
    EXPECT_NEAR(measured, blur, 0.4) << blur;
  }
}

TEST(EdgeBlur, IsNoneWithoutEdges) {
  EXPECT_EQ(edge_blur_px(FloatImage({240, 200}, 50), {5, 4, std::vector<std::optional<Vector2d>>(20)}), 0);
}

TEST(SquareSize, IsTheMeanOverNeighboursThatAreSeen) {
  ChessboardCorners corners{3, 2, {}};
  for (const Vector2d& at : {Vector2d(0, 0), Vector2d(10, 0), Vector2d(22, 0),  //
                             Vector2d(0, 8), Vector2d(10, 8), Vector2d(22, 8)})
    corners.corners.emplace_back(at);
  EXPECT_NEAR(square_px(corners), (2 * 10 + 2 * 12 + 3 * 8) / 7.0, 1e-12);
  corners.corners[0].reset();
  EXPECT_NEAR(square_px(corners), (10 + 2 * 12 + 2 * 8) / 5.0, 1e-12);
  EXPECT_EQ(square_px({3, 2, std::vector<std::optional<Vector2d>>(6)}), 0);
}

}  // namespace
}  // namespace bodyscan
