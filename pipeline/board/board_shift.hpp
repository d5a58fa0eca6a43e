#pragma once

#include "pipeline/board/chessboard.hpp"
#include "pipeline/image/frame.hpp"

#include <optional>

namespace bodyscan {

// How far a board's corners, where they can still be seen, lie from where they were, up to half a square:
// median, px; nothing where too few can be seen to tell.
std::optional<double> board_shift_px(const Luma& later, const ChessboardCorners& before);

}  // namespace bodyscan
