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
  // Between the outermost corners, board frame.
  [[nodiscard]] Eigen::Vector3d middle_mm() const {
    return square_mm / 2 * Eigen::Vector3d(columns - 1, rows - 1, 0);
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
  // Whether it looks the same from each of its four sides.
  [[nodiscard]] bool square() const { return columns == rows; }
  // Of the same board counted from its next corner: square ones only.
  [[nodiscard]] Eigen::Vector2d quarter_turned(const Eigen::Vector2d& px) const {
    const Eigen::Vector2d middle = (corner_px(0) + corner_px(corner_count() - 1)) / 2;
    return middle + Eigen::Vector2d(middle.y() - px.y(), px.x() - middle.x());
  }
  // Of the same board counted from its opposite corner.
  [[nodiscard]] Eigen::Vector2d half_turned(const Eigen::Vector2d& px) const {
    return corner_px(0) + corner_px(corner_count() - 1) - px;
  }
};

}  // namespace bodyscan
