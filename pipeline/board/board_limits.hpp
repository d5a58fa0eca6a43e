#pragma once

namespace bodyscan {

// The boards that there are, printed and projected: inner corners along a side, and the side of a square.
constexpr int min_board_corners = 3;
constexpr int max_board_corners = 100;
constexpr double min_square_mm = 0.1;
constexpr double max_square_mm = 1000;  // below, not equal
constexpr double min_square_px = 2;     // projected

}  // namespace bodyscan
