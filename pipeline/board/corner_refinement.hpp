#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/board/chessboard.hpp"

#include <optional>

#include <Eigen/Core>

namespace bodyscan {

// The point to which all brightness gradients in a window of 2 half_window + 1 px are most nearly orthogonal
// (Foerstner and Guelch 1987), iterated; `weight`, if any, is the pixels' weight in the same raster. Nothing
// where it runs away or the window shows no corner.
std::optional<Eigen::Vector2d> refine_corner(const FloatImage& image, const FloatImage* weight,
                                             const Eigen::Vector2d& start, double half_window);

// Every corner of a board, in a window of about a third of a square; those that do not hold are left out.
ChessboardCorners refine_corners(const FloatImage& image, const FloatImage* weight,
                                 const ChessboardCorners& board);

// Standard deviation, px, of the blur of the edges between neighbouring corners, median; 0 where there are
// none.
double edge_blur_px(const FloatImage& image, const ChessboardCorners& board);

// Mean distance of neighbouring corners, px.
double square_px(const ChessboardCorners& board);

}  // namespace bodyscan
