#include "tools/simulator/projected_chessboard.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

constexpr Size projector{256, 192};
// Squares from column 57 to 196 and from row 41 to 152.
const ProjectedBoard board{9, 7, {70.5, 54.5}, 14};

double edge(double distance, double sigma) {
  return 0.5 * (1 + std::erf(distance / (sigma * std::sqrt(2.0))));
}

bool is_black(int column, int row) {
  const int x = column - 57;
  const int y = row - 41;
  return x >= 0 && y >= 0 && x < 140 && y < 112 && (x / 14 + y / 14) % 2 == 0;
}

TEST(ProjectedChessboard, WithoutBlurEveryPixelIsBlackOrWhite) {
  const ProjectedChessboard light(board, projector, 0, 0);
  int white = 0;
  for (int row = 0; row < projector.height; ++row) {
    for (int column = 0; column < projector.width; ++column) {
      const float wanted = is_black(column, row) ? 0 : 1;
      white += is_black(column, row) ? 0 : 1;
      for (const float offset : {-0.45F, 0.45F}) {
        const auto value = light.at(static_cast<float>(column) + offset, static_cast<float>(row) - offset);
        ASSERT_EQ(value.focused, wanted) << column << ' ' << row;
        ASSERT_EQ(value.scatter_change, 0);
      }
    }
  }
  EXPECT_NEAR(light.mean(), white / 256.0 / 192, 1e-6);
}

TEST(ProjectedChessboard, BlurredEdgesAreTheGaussiansIntegral) {
  const double defocus = 0.8;
  const double scattered = 1.5;
  const ProjectedChessboard light(board, projector, defocus, scattered);
  // Along the middle of the top row of squares, whose own edges are 7 px away: black, then white.
  for (double distance = -3; distance <= 3; distance += 0.037) {
    const auto column = light.at(static_cast<float>(70.5 + distance), 47.5F);
    EXPECT_NEAR(column.focused, edge(distance, defocus), 3e-4) << distance;
    EXPECT_NEAR(column.focused + column.scatter_change, edge(distance, scattered), 3e-4) << distance;
    const auto row = light.at(63.5F, static_cast<float>(54.5 + distance));
    EXPECT_NEAR(row.focused, edge(distance, defocus), 3e-4) << distance;
    const auto border = light.at(static_cast<float>(56.5 + distance), 47.5F);
    EXPECT_NEAR(border.focused, edge(-distance, defocus), 3e-4) << distance;
  }
}

TEST(ProjectedChessboard, ABlurredCornerIsASaddleAtItsPlace) {
  const double sigma = 0.8;
  const ProjectedChessboard light(board, projector, sigma, sigma);
  for (int i = 0; i < board.corner_count(); ++i) {
    const Eigen::Vector2f corner = board.corner_px(i).cast<float>();
    EXPECT_NEAR(light.at(corner.x(), corner.y()).focused, 0.5, 3e-4) << i;
  }
  // The first corner, black to its upper left and lower right: a product of two edges.
  for (const auto& [x, y] : {std::pair{0.5, 0.7}, {-0.6, 0.3}, {1.1, -0.4}, {-0.2, -0.9}}) {
    const double wanted = 0.5 - (2 * edge(x, sigma) - 1) * (2 * edge(y, sigma) - 1) / 2;
    EXPECT_NEAR(light.at(static_cast<float>(70.5 + x), static_cast<float>(54.5 + y)).focused, wanted, 3e-4);
  }
}

TEST(FitProjectedBoard, SquaresOfWholePixelsSpanTheShareInTheMiddle) {
  for (const double share : {0.2, 0.6, 1.0}) {
    for (const Size size : {Size{256, 192}, Size{1024, 768}, Size{600, 801}}) {
      const ProjectedBoard fitted = fit_projected_board(size, 9, 7, share);
      EXPECT_EQ(fitted.columns, 9);
      EXPECT_EQ(fitted.rows, 7);
      EXPECT_EQ(fitted.square_px, std::floor(share * std::min(size.width / 10.0, size.height / 8.0)));
      const Eigen::Vector2d before = fitted.first_corner_px.array() - fitted.square_px + 0.5;
      const Eigen::Vector2d behind =
          Eigen::Vector2d(size.width, size.height) - before - fitted.square_px * Eigen::Vector2d(10, 8);
      for (int k = 0; k < 2; ++k) {
        EXPECT_EQ(before[k], std::floor(before[k]));
        EXPECT_GE(before[k], 0);
        EXPECT_GE(behind[k], before[k]);
        EXPECT_LE(behind[k], before[k] + 1);
      }
    }
  }
}

TEST(FitProjectedBoard, SquaresBelowTwoPixelsAreNone) {
  EXPECT_EQ(fit_projected_board({256, 192}, 9, 7, 0.09).square_px, 2);
  EXPECT_EQ(fit_projected_board({256, 192}, 9, 7, 0.08).square_px, 0);
}

}  // namespace
}  // namespace bodyscan::simulator
