#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/board/board.hpp"
#include "pipeline/board/chessboard.hpp"
#include "pipeline/image/frame.hpp"

namespace bodyscan {

// A board in a picture, upright (turned_upright), some corners perhaps missing.
struct FoundBoard {
  ChessboardCorners corners;
  double edge_blur_px = 0;  // standard deviation
};

// The printed board's corners, searched at reduced size and refined at full size. Errors say what is wrong
// with the picture: no board, another size, cut off.
Expected<FoundBoard> find_printed_board(const Luma& picture, const PrintedBoard& board);

// The projected board's corners in `projected`, the same view as `printed` with the projected board on top or
// beside: on the ratio of the two pictures, in which the print cancels; failing that on the picture itself
// without the printed corners.
Expected<FoundBoard> find_projected_board(const Luma& printed, const Luma& projected,
                                          const FoundBoard& printed_board, const ProjectedBoard& board);

}  // namespace bodyscan
