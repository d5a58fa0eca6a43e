#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/board/board.hpp"

#include <string>
#include <vector>

#include <Eigen/Core>

namespace bodyscan {

// A black rectangle on a sheet; mm from the sheet's upper left corner, y down.
struct PageRectangle {
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  // upper left
  Eigen::Vector2d size = Eigen::Vector2d::Zero();
};

struct PageText {
  Eigen::Vector2d start = Eigen::Vector2d::Zero();  // of the baseline
  bool upwards = false;  // written from the bottom to the top instead of from left to right
  std::string text;      // ASCII
};

// A sheet with a chessboard and a ruler.
struct BoardPage {
  Eigen::Vector2d size_mm = Eigen::Vector2d::Zero();
  std::vector<PageRectangle> squares;  // the black ones
  std::vector<PageRectangle> ruler;
  std::vector<PageText> texts;
  double white_mm = 0;  // of paper around the board, at its narrowest
};

constexpr double page_text_mm = 3;  // font size; the font is Helvetica

// The board with its outer squares, black in the upper left, in the middle of a sheet of `paper_mm` (width
// and height, turned as suits better). On the lower margin, or on the right one where the board leaves no
// other room, a ruler of 100 mm. White of one square around the board where the sheet allows it; at least
// 5 mm, about what printers leave white by themselves. A sheet that is too small is a usage error that says
// what is needed.
Expected<BoardPage> printable_board(const PrintedBoard& board, const Eigen::Vector2d& paper_mm);

}  // namespace bodyscan
