#pragma once

#include <Eigen/Core>

namespace bodyscan {

// A printed chessboard; columns and rows count inner corners. Board frame: the corners' plane, origin at
// corner (0, 0), x along the columns, y along the rows, mm.
struct PrintedBoard {
  int columns = 0;
  int rows = 0;
  double square_mm = 0;

  [[nodiscard]] int corner_count() const { return columns * rows; }
  // Of corner `index`, counted row by row.
  [[nodiscard]] Eigen::Vector2d corner_mm(int index) const {
    return square_mm * Eigen::Vector2d(index % columns, index / columns);
  }
};

// A chessboard in the projector's picture.
struct ProjectedBoard {
  int columns = 0;
  int rows = 0;
  Eigen::Vector2d first_corner_px = Eigen::Vector2d::Zero();
  double square_px = 0;

  [[nodiscard]] int corner_count() const { return columns * rows; }
  [[nodiscard]] Eigen::Vector2d corner_px(int index) const {
    return first_corner_px + square_px * Eigen::Vector2d(index % columns, index / columns);
  }
};

}  // namespace bodyscan
