#include "pipeline/drawing/printable_board.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr PrintedBoard usual{.columns = 9, .rows = 7, .square_mm = 25};
const Vector2d a4(210, 297);
const Vector2d a3(297, 420);

BoardPage page_of(const PrintedBoard& board, const Vector2d& paper) {
  const Expected<BoardPage> page = printable_board(board, paper);
  EXPECT_TRUE(page) << page.error().message;
  return page.value_or(BoardPage{});
}

void expect_inside(const BoardPage& page, const PageRectangle& shape, double margin) {
  EXPECT_GE(shape.corner.minCoeff(), margin - 1e-9);
  EXPECT_TRUE(((page.size_mm - shape.corner - shape.size).array() >= margin - 1e-9).all());
}

TEST(PrintableBoard, HasEveryBlackSquareAtItsPlace) {
  const BoardPage page = page_of(usual, a3);
  ASSERT_EQ(page.squares.size(), 40U);  // of 10 x 8
  const Vector2d first = page.squares[0].corner;
  std::size_t index = 0;
  for (int row = 0; row < 8; ++row) {
    for (int column = 0; column < 10; ++column) {
      if ((row + column) % 2 != 0) continue;
      EXPECT_TRUE(page.squares[index].corner.isApprox(first + 25 * Vector2d(column, row)));
      EXPECT_EQ(page.squares[index].size, Vector2d(25, 25));
      ++index;
    }
  }
  for (const PageRectangle& square : page.squares) expect_inside(page, square, 25);
}

TEST(PrintableBoard, ChoosesLandscapeAndARulerBelow) {
  const BoardPage page = page_of(usual, a3);
  EXPECT_EQ(page.size_mm, Vector2d(420, 297));
  EXPECT_GE(page.white_mm, 25);
  for (const PageRectangle& tick : page.ruler) {
    expect_inside(page, tick, 4.9);  // a tick is 0.2 mm wide
    EXPECT_GT(tick.corner.y(), page.squares.back().corner.y() + 25 + 25);
  }
  EXPECT_EQ(page_of({.columns = 5, .rows = 9, .square_mm = 20}, a4).size_mm, a4);
}

TEST(PrintableBoard, FillsA4WithTheUsualBoard) {
  const BoardPage page = page_of(usual, a4);
  EXPECT_EQ(page.size_mm, Vector2d(297, 210));
  EXPECT_DOUBLE_EQ(page.white_mm, 5);
  for (const PageRectangle& square : page.squares) expect_inside(page, square, 5);
  for (const PageRectangle& tick : page.ruler) {
    expect_inside(page, tick, 4.9);                                   // a tick is 0.2 mm wide
    EXPECT_GT(tick.corner.x(), page.squares[4].corner.x() + 50 + 5);  // right of the board
  }
  for (const PageText& text : page.texts) EXPECT_TRUE(text.upwards);
}

TEST(PrintableBoard, RulerHasATickEveryMillimetreAndANumberEveryTen) {
  for (const Vector2d& paper : {a3, a4}) {
    const BoardPage page = page_of(usual, paper);
    ASSERT_EQ(page.ruler.size(), 102U);  // and its line
    const bool below = paper == a3;
    const Vector2d first = page.ruler[1].corner + page.ruler[1].size / 2;
    for (int mm = 0; mm <= 100; ++mm) {
      const PageRectangle& tick = page.ruler[static_cast<std::size_t>(mm) + 1];
      const Vector2d middle = tick.corner + tick.size / 2;
      EXPECT_NEAR(below ? middle.x() - first.x() : first.y() - middle.y(), mm, 1e-9);
      EXPECT_EQ(below ? tick.size.y() : tick.size.x(), mm % 10 == 0 ? 5.5 : mm % 5 == 0 ? 4 : 3);
    }
    ASSERT_EQ(page.texts.size(), 13U);
    EXPECT_EQ(page.texts[0].text, "0");
    EXPECT_EQ(page.texts[10].text, "100");
    EXPECT_EQ(page.texts[11].text, "measure this ruler: 100 mm");
    EXPECT_EQ(page.texts[12].text, "9 x 7 inner corners, squares of 25 mm, board 250 x 200 mm");
    const Vector2d step = page.texts[5].start - page.texts[4].start;  // "50" and "40"
    EXPECT_NEAR(below ? step.x() : -step.y(), 10, 1e-9);
  }
}

TEST(PrintableBoard, SaysWhatPaperIsNeeded) {
  const auto page = printable_board({.columns = 9, .rows = 7, .square_mm = 25.125}, a4);
  ASSERT_FALSE(page);
  EXPECT_EQ(page.error().kind, ErrorKind::usage);
  EXPECT_EQ(page.error().message,
            "a board of 251.25 x 201 mm and its ruler need paper of 261.25 x 233 mm or 283.25 x 211 mm, not "
            "210 x 297 mm");
  EXPECT_TRUE(printable_board({.columns = 9, .rows = 7, .square_mm = 25.125}, {233, 261.25}));
  EXPECT_TRUE(printable_board({.columns = 9, .rows = 7, .square_mm = 25.125}, {211, 283.25}));
  EXPECT_FALSE(printable_board({.columns = 9, .rows = 7, .square_mm = 25.125}, {211, 283}));
}

TEST(PrintableBoard, ASmallBoardStillNeedsPaperForTheRuler) {
  const PrintedBoard small{.columns = 3, .rows = 3, .square_mm = 5};
  EXPECT_TRUE(printable_board(small, {110, 52}));
  EXPECT_FALSE(printable_board(small, {109, 100}));
}

}  // namespace
}  // namespace bodyscan
