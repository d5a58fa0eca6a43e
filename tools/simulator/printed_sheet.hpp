#pragma once

#include "pipeline/board/board.hpp"

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace bodyscan::simulator {

// What a chessboard is printed on.
struct SheetForm {
  // How far the middle lies from the chord between the left and the right edge, which go back from the viewer
  // (negative: come forward): the sheet is a cylinder about an axis along the rows' direction. 0: flat.
  double bend_mm = 0;
  double plate_mm = 0;  // white plate that the sheet lies on, beyond the sheet on every side
  double edge_mm = 0;  // over which an edge of ink or paper fades linearly, its middle where the edge belongs
};

// A chessboard of (columns + 1) x (rows + 1) squares, the top left one black, with a white margin of one
// square. Board frame (mm): origin at inner corner (0, 0), x along the columns, y along the rows, z away from
// the viewer. Paper coordinates (mm) run along the paper and are the board frame's x and y where the sheet is
// flat; a bent sheet touches the flat one's plane along its middle.
class PrintedSheet {
 public:
  PrintedSheet(const PrintedBoard& board, const SheetForm& form);

  [[nodiscard]] const PrintedBoard& board() const { return board_; }
  [[nodiscard]] const SheetForm& form() const { return form_; }

  // Paper coordinates: the squares' middle, half the sheet's sides, half the sides of sheet and plate.
  [[nodiscard]] Eigen::Vector2d middle() const { return middle_; }
  [[nodiscard]] Eigen::Vector2d half_sheet() const { return half_sheet_; }
  [[nodiscard]] Eigen::Vector2d half_plate() const { return half_plate_; }
  [[nodiscard]] bool is_flat() const { return curvature_ == 0; }

  // Paper coordinates to the board frame and back (of points on the paper).
  [[nodiscard]] Eigen::Vector3d point(const Eigen::Vector2d& paper) const;
  [[nodiscard]] Eigen::Vector2d paper(const Eigen::Vector3d& point) const;
  // Where a ray of the board frame meets sheet or plate; nothing if it misses both.
  [[nodiscard]] std::optional<Eigen::Vector2d> hit(const Eigen::Vector3d& origin,
                                                   const Eigen::Vector3d& direction) const;
  // Linear reflectance, the same in red, green and blue.
  [[nodiscard]] float albedo(const Eigen::Vector2d& paper) const;

 private:
  PrintedBoard board_;
  SheetForm form_;
  Eigen::Vector2d middle_;
  Eigen::Vector2d half_sheet_;
  Eigen::Vector2d half_plate_;
  double curvature_ = 0;  // 1/mm
};

}  // namespace bodyscan::simulator
