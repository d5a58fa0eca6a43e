#pragma once

#include "pipeline/board/saddle_points.hpp"

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace bodyscan {

// Inner corners of a chessboard in a picture, row by row; right-handed: from the first column's direction to
// the first row's is a turn as from x (right) to y (down).
struct ChessboardCorners {
  int columns = 0;
  int rows = 0;
  std::vector<std::optional<Eigen::Vector2d>> corners;  // px; nothing where one was not seen

  [[nodiscard]] const std::optional<Eigen::Vector2d>& at(int column, int row) const {
    return corners[static_cast<std::size_t>(row * columns + column)];
  }
  [[nodiscard]] int found() const;
  [[nodiscard]] bool complete() const { return found() == columns * rows; }
};

// The same board with `columns` x `rows` corners, turned so that columns count towards the picture's lower
// right: to the right in a board that stands as the picture, downwards in one on its side, to the right in a
// square one; nothing where its sides are others. A board whose colours do not change under half a turn looks
// the same upside down, so this is a convention.
std::optional<ChessboardCorners> turned_upright(const ChessboardCorners& board, int columns, int rows);

// Boards that grow from the saddle points, largest first: neighbouring corners lie where the ones before
// point, bright and dark change places from each to the next. No corner belongs to two boards.
std::vector<ChessboardCorners> grow_chessboards(std::span<const SaddlePoint> saddles);

}  // namespace bodyscan
