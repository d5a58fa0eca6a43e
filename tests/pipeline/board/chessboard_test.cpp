#include "pipeline/board/chessboard.hpp"

#include <algorithm>
#include <chrono>
#include <random>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

// Corners at the distance of a square, `right` the columns' direction, `down` the rows'.
ChessboardCorners grid(int columns, int rows, const Vector2d& right, const Vector2d& down) {
  ChessboardCorners board{columns, rows, {}};
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      board.corners.emplace_back(Vector2d(300, 300) + column * right + row * down);
  return board;
}

std::vector<SaddlePoint> saddles_of(const ChessboardCorners& board) {
  const Vector2d right = (*board.at(1, 0) - *board.at(0, 0)).normalized();
  const Vector2d down = (*board.at(0, 1) - *board.at(0, 0)).normalized();
  std::vector<SaddlePoint> saddles;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column)
      if (board.at(column, row))
        saddles.push_back({*board.at(column, row), {right, down}, (column + row) % 2 == 0, 0.6F});
  return saddles;
}

void expect_same(const ChessboardCorners& found, const ChessboardCorners& expected) {
  ASSERT_EQ(found.columns, expected.columns);
  ASSERT_EQ(found.rows, expected.rows);
  for (std::size_t i = 0; i < expected.corners.size(); ++i)
    EXPECT_EQ(found.corners[i], expected.corners[i]) << i;
}

TEST(ChessboardCorners, CountWhatIsSeen) {
  ChessboardCorners board = grid(4, 3, {20, 0}, {0, 20});
  EXPECT_TRUE(board.complete());
  board.corners[5].reset();
  EXPECT_EQ(board.found(), 11);
  EXPECT_FALSE(board.complete());
}

TEST(TurnedUpright, AnyTurnGivesTheSameBoard) {
  ChessboardCorners upright = grid(4, 3, {20, 3}, {-3, 20});
  upright.corners[1].reset();
  ChessboardCorners half = upright;
  std::ranges::reverse(half.corners);
  // Counted down the picture first, and row by row towards its left.
  ChessboardCorners quarter{3, 4, {}};
  for (int column = 0; column < 4; ++column)
    for (int row = 2; row >= 0; --row) quarter.corners.push_back(upright.at(column, row));
  for (const ChessboardCorners& board : {upright, half, quarter}) {
    const auto turned = turned_upright(board, 4, 3);
    ASSERT_TRUE(turned);
    expect_same(*turned, upright);
  }
}

TEST(TurnedUpright, ColumnsThatRunUpAndDownCountDownwards) {
  const ChessboardCorners down = grid(4, 3, {0, 20}, {-20, 0});
  ChessboardCorners up = down;
  std::ranges::reverse(up.corners);
  for (const ChessboardCorners& board : {down, up}) {
    const auto turned = turned_upright(board, 4, 3);
    ASSERT_TRUE(turned);
    expect_same(*turned, down);
  }
}

TEST(TurnedUpright, ASquareBoardHasItsColumnsAlongThePicture) {
  for (const double slope : {5.0, 0.1, 0.0, -0.1, -5.0}) {
    const ChessboardCorners upright = grid(4, 4, {20, slope}, {-slope, 20});
    ChessboardCorners quarter{4, 4, {}};
    for (int column = 0; column < 4; ++column)
      for (int row = 3; row >= 0; --row) quarter.corners.push_back(upright.at(column, row));
    for (const ChessboardCorners& board : {upright, quarter}) {
      const auto turned = turned_upright(board, 4, 4);
      ASSERT_TRUE(turned);
      expect_same(*turned, upright);
    }
  }
}

TEST(TurnedUpright, NothingForOtherSides) {
  const ChessboardCorners board = grid(4, 3, {20, 0}, {0, 20});
  EXPECT_FALSE(turned_upright(board, 4, 4));
  EXPECT_FALSE(turned_upright(board, 5, 3));
  EXPECT_FALSE(turned_upright(board, 6, 2));
}

TEST(GrowingChessboards, ABoardAmongStraySaddles) {
  const ChessboardCorners board = grid(7, 5, {30, 6}, {-5, 28});
  std::vector<SaddlePoint> saddles = saddles_of(board);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(100, 700);
  for (int i = 0; i < 60; ++i)
    saddles.push_back(
        {{place(random), place(random)}, {Vector2d(0.8, 0.6), Vector2d(-0.6, 0.8)}, i % 2 == 0, 0.3F});
  const auto boards = grow_chessboards(saddles);
  ASSERT_EQ(boards.size(), 1U);
  const auto upright = turned_upright(boards[0], 7, 5);
  ASSERT_TRUE(upright);
  expect_same(*upright, board);
}

TEST(GrowingChessboards, AHoleStaysOne) {
  ChessboardCorners board = grid(7, 5, {30, 0}, {0, 30});
  board.corners[16].reset();
  board.corners[0].reset();
  const auto boards = grow_chessboards(saddles_of(board));
  ASSERT_EQ(boards.size(), 1U);
  const auto upright = turned_upright(boards[0], 7, 5);
  ASSERT_TRUE(upright);
  expect_same(*upright, board);
}

TEST(GrowingChessboards, TwoSaddlesAtTheRimAreNoRow) {
  const ChessboardCorners board = grid(7, 5, {30, 0}, {0, 30});
  std::vector<SaddlePoint> saddles = saddles_of(board);
  for (const int column : {2, 3}) {
    SaddlePoint below = saddles[static_cast<std::size_t>(3 * 7 + column)];
    below.at.y() += 60;
    saddles.push_back(below);
  }
  const auto boards = grow_chessboards(saddles);
  ASSERT_EQ(boards.size(), 1U);
  const auto upright = turned_upright(boards[0], 7, 5);
  ASSERT_TRUE(upright);
  expect_same(*upright, board);
}

TEST(GrowingChessboards, TheLargestFirst) {
  std::vector<SaddlePoint> saddles = saddles_of(grid(4, 3, {20, 0}, {0, 20}));
  for (SaddlePoint saddle : saddles_of(grid(6, 5, {25, 0}, {0, 25}))) {
    saddle.at += Vector2d(500, 500);
    saddles.push_back(saddle);
  }
  const auto boards = grow_chessboards(saddles);
  ASSERT_EQ(boards.size(), 2U);
  EXPECT_EQ(boards[0].found(), 30);
  EXPECT_EQ(boards[1].found(), 12);
}

TEST(GrowingChessboards, NeighboursThatDoNotChangePlacesMakeNoBoard) {
  std::vector<SaddlePoint> saddles = saddles_of(grid(7, 5, {30, 0}, {0, 30}));
  for (SaddlePoint& saddle : saddles) saddle.positive = true;  // dots in a grid, not squares
  EXPECT_TRUE(grow_chessboards(saddles).empty());
}

// A picture full of small squares must not hold up a session: a fraction of a second, minutes where every
// corner is compared with every other.
TEST(GrowingChessboards, AHundredThousandCornersTakeNoMinutes) {
  const std::vector<SaddlePoint> saddles = saddles_of(grid(400, 250, {6, 0}, {0, 6}));
  const auto start = std::chrono::steady_clock::now();
  const auto boards = grow_chessboards(saddles);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  ASSERT_EQ(boards.size(), 1U);
  EXPECT_EQ(boards[0].found(), 100000);
}

TEST(GrowingChessboards, NothingFromNothing) {
  EXPECT_TRUE(grow_chessboards({}).empty());
  EXPECT_TRUE(grow_chessboards(saddles_of(grid(4, 2, {30, 0}, {0, 30}))).empty()) << "8 corners";
}

}  // namespace
}  // namespace bodyscan
