#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/board/board.hpp"
#include "pipeline/board/chessboard.hpp"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace bodyscan {

// How a board is held before a camera without distortion whose axis meets the picture's middle.
struct BoardView {
  Size picture{480, 360};
  double square_px = 32;                                // at the board's middle, before it is tilted
  Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();  // of the board, from the picture's middle
  double roll_degrees = 0;                              // in the picture, from x (right) to y (down)
  double tilt_degrees = 0;                              // away from facing the camera
  double tilt_axis_degrees = 90;                        // of the axis it is tilted about, in the picture
  double focal_px = 600;                                // short: strong perspective
};

// Board mm to picture px.
Eigen::Matrix3d picture_from_board(const PrintedBoard& board, const BoardView& view);

// The projector's light on the board's plane: a chessboard, and white around its squares.
struct ProjectedLight {
  ProjectedBoard board;
  Eigen::Matrix3d projector_from_board = Eigen::Matrix3d::Identity();  // board mm to projector px
  double dark = 0.05;  // light of its dark squares; the bright ones' is 1
};

// What is photographed, and how; light is linear, 1 the camera's full scale.
struct BoardPicture {
  double white = 0.7;       // of the sheet
  double black = 0.05;      // of the printed squares
  double background = 0.2;  // around the sheet
  double margin_squares = 1;
  double uneven = 0;  // share of the light lost from the picture's left to its right
  std::optional<ProjectedLight> projected = std::nullopt;
  double blur_px = 0.5;  // standard deviation of the Gaussian, beside the pixel's own square
  double exposure = 1;
  double noise = 0;  // standard deviation, linear light
  bool mirrored = false;
  unsigned seed = 1;
};

struct Photograph {
  GrayImage8 picture;                      // sRGB
  std::vector<Eigen::Vector2d> printed;    // true corners, px, counted as the board's
  std::vector<Eigen::Vector2d> projected;  // likewise, where a board was projected
};

Photograph photograph(const PrintedBoard& board, const Eigen::Matrix3d& picture_from_board, Size size,
                      const BoardPicture& how);

// Corners found against true ones of the same index.
struct CornerErrors {
  int found = 0;
  double rms = 0;    // px
  double worst = 0;  // px
};

CornerErrors compare(const ChessboardCorners& found, const std::vector<Eigen::Vector2d>& truth);

// The corners of the same board counted from its opposite corner.
std::vector<Eigen::Vector2d> half_a_turn(std::vector<Eigen::Vector2d> corners);

}  // namespace bodyscan
