#include "tools/simulator/projected_chessboard.hpp"

#include <algorithm>
#include <cmath>

namespace bodyscan::simulator {
namespace {

struct Squares {  // along one side of the board
  double first_corner_px;
  double square_px;
  int corners;
  int length_px;  // of the picture's side

  // Number of the square that a pixel lies in; -1 or less before the board, corners + 1 or more behind it.
  [[nodiscard]] int square_of(int pixel) const {
    return static_cast<int>(std::floor((pixel - first_corner_px) / square_px)) + 1;
  }
  [[nodiscard]] bool holds(int pixel) const { return square_of(pixel) >= 0 && square_of(pixel) <= corners; }

  [[nodiscard]] std::vector<float> inside() const {
    std::vector<float> pixels(static_cast<std::size_t>(length_px));
    for (int i = 0; i < length_px; ++i) pixels[static_cast<std::size_t>(i)] = holds(i) ? 1.0F : 0.0F;
    return pixels;
  }
  [[nodiscard]] std::vector<float> sides() const {
    std::vector<float> pixels = inside();
    for (int i = 0; i < length_px; ++i) {
      if (square_of(i) % 2 != 0) pixels[static_cast<std::size_t>(i)] *= -1;
    }
    return pixels;
  }
};

Squares along_columns(const ProjectedBoard& board, Size projector) {
  return {board.first_corner_px.x(), board.square_px, board.columns, projector.width};
}

Squares along_rows(const ProjectedBoard& board, Size projector) {
  return {board.first_corner_px.y(), board.square_px, board.rows, projector.height};
}

float sum(const std::vector<float>& pixels) {
  float total = 0;
  for (const float pixel : pixels) total += pixel;
  return total;
}

}  // namespace

ProjectedChessboard::ProjectedChessboard(const ProjectedBoard& board, Size projector, double defocus,
                                         double scattered)
    : inside_columns_(along_columns(board, projector).inside(), defocus, scattered),
      inside_rows_(along_rows(board, projector).inside(), defocus, scattered),
      side_columns_(along_columns(board, projector).sides(), defocus, scattered),
      side_rows_(along_rows(board, projector).sides(), defocus, scattered) {
  const float squares =
      sum(along_columns(board, projector).inside()) * sum(along_rows(board, projector).inside());
  const float sides =
      sum(along_columns(board, projector).sides()) * sum(along_rows(board, projector).sides());
  mean_ = 1 - (squares + sides) / 2 / static_cast<float>(projector.area());
}

ProjectedBoard fit_projected_board(Size projector, int columns, int rows, double share) {
  constexpr int smallest_square_px = 2;
  const int square = static_cast<int>(share * std::min(static_cast<double>(projector.width) / (columns + 1),
                                                       static_cast<double>(projector.height) / (rows + 1)));
  ProjectedBoard board{columns, rows, Eigen::Vector2d::Zero(), 0};
  if (square < smallest_square_px) return board;
  board.square_px = square;
  const auto first = [&](int length, int corners) {
    return (length - (corners + 1) * square) / 2 + square - 0.5;
  };
  board.first_corner_px = {first(projector.width, columns), first(projector.height, rows)};
  return board;
}

}  // namespace bodyscan::simulator
