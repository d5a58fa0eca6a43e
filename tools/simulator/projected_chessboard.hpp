#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/board/board.hpp"
#include "tools/simulator/blurred_row.hpp"

namespace bodyscan::simulator {

// The light of a projected chessboard as a share of white's. Its squares reach one square beyond the inner
// corners, the top left one is black; the rest of the picture is white:
//   p(column, row) = 1 - (inside(column) inside(row) + side(column) side(row)) / 2
// with inside 1 over the squares and 0 beyond, side +1 and -1 by turns over the squares and 0 beyond. Both
// terms are products of a function of the column and one of the row, so each is blurred exactly by blurring
// its factors.
class ProjectedChessboard {
 public:
  // The squares' edges lie on edges of pixels (first_corner_px at half, square_px at whole numbers) and
  // inside the picture. The blurs are BlurredRow's.
  ProjectedChessboard(const ProjectedBoard& board, Size projector, double defocus, double scattered);

  using Value = BlurredRow::Value;
  [[nodiscard]] Value at(float column, float row) const {
    const Value inside = product(inside_columns_.at(column), inside_rows_.at(row));
    const Value sides = product(side_columns_.at(column), side_rows_.at(row));
    return {1 - (inside.focused + sides.focused) / 2, -(inside.scatter_change + sides.scatter_change) / 2};
  }
  // Mean over the picture, 0..1.
  [[nodiscard]] float mean() const { return mean_; }

 private:
  static Value product(const Value& a, const Value& b) {
    const float focused = a.focused * b.focused;
    return {focused, (a.focused + a.scatter_change) * (b.focused + b.scatter_change) - focused};
  }

  BlurredRow inside_columns_;
  BlurredRow inside_rows_;
  BlurredRow side_columns_;
  BlurredRow side_rows_;
  float mean_;
};

// A chessboard of `columns` x `rows` inner corners in the middle of the projector's picture, its squares
// spanning `share` (up to 1) of the picture's width or height, whichever is less. Its square_px is 0 where
// squares would be smaller than 2 px.
ProjectedBoard fit_projected_board(Size projector, int columns, int rows, double share);

}  // namespace bodyscan::simulator
