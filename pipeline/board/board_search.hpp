#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"
#include "pipeline/board/chessboard.hpp"

#include <string>
#include <vector>

#include <Eigen/Core>

namespace bodyscan {

// Boards are searched in a picture reduced by this factor.
int search_factor(Size whole);

// Positions in a picture reduced by `factor` to those in the whole.
ChessboardCorners enlarged(ChessboardCorners board, int factor);

// Corners that are known already, in the reduced picture.
struct KnownCorners {
  std::vector<Eigen::Vector2d> corners;
  double radius = 0;  // about each, where no other is looked for

  [[nodiscard]] bool holds(const Eigen::Vector2d& at) const;
};

// Of a board in the whole picture.
KnownCorners known_corners(const ChessboardCorners& board, int factor);

constexpr double min_found = 0.8;  // share of a board's corners

// A board of that size among other corners than the known ones, in a reduced picture of grey levels
// (board_pictures.hpp); its corners are good to a pixel or so. The error, "WHAT: ...", says what was seen
// instead.
Expected<ChessboardCorners> search_board(const FloatImage& image, int columns, int rows,
                                         const std::string& what, const KnownCorners& known = {});

}  // namespace bodyscan
