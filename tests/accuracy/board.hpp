#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/geometry/lens.hpp"
#include "pipeline/model/mesh.hpp"

#include <filesystem>
#include <vector>

#include <Eigen/Core>

namespace bodyscan {

// A printed chessboard as one picture shows it. Board coordinates count squares: inner corners are the
// integers (0, 0) to (8, 6), the printed squares reach one further.
class Board {
 public:
  static constexpr int columns = 9;  // inner corners
  static constexpr int rows = 7;

  // Throws std::runtime_error where the picture shows no such board.
  static Board find(const std::filesystem::path& picture, const Lens& camera);

  // Where a camera ray (x/z, y/z, 1) meets the board.
  [[nodiscard]] Eigen::Vector2d at(const Eigen::Vector3d& ray) const;
  // Whether that place is inside the judged squares.
  [[nodiscard]] static bool inside(const Eigen::Vector2d& place);
  // Whether it is inside a white square, 5 % of its side away from the edges.
  [[nodiscard]] bool on_white(const Eigen::Vector2d& place) const;

 private:
  Eigen::Matrix3d board_from_ray_ = Eigen::Matrix3d::Identity();
  int white_parity_ = 0;  // (column + row) & 1 of the white squares
};

// Figures of a model of that board; lengths in squares' sides.
struct BoardFigures {
  std::size_t points = 0;    // on the judged squares
  double plane_rms = 0;      // of the plane's residuals after leaving out those over 4 sigma, repeatedly
  double p95 = 0;            // of all points' distances from that plane
  double white_covered = 0;  // share of the white squares' pixels that have a point
};
BoardFigures measure_board(const Board& board, const Lens& camera, const Mesh& model, double square_mm);

}  // namespace bodyscan
