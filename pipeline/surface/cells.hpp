#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"
#include "pipeline/geometry/lens.hpp"
#include "pipeline/geometry/point_grid.hpp"
#include "pipeline/surface/clean.hpp"

#include <cstddef>
#include <cstdint>

namespace bodyscan {

// The triangles of the four neighbouring pixels
//   a b    a = (x, y)
//   c d
// in a byte: the cell is cut along a-d into (a, c, d) and (a, d, b), or along b-c into (a, c, b) and (b, c,
// d). Each of the triangles may be missing. The order is counter-clockwise seen from the camera.
namespace cell {
inline constexpr std::uint8_t first = 1;   // the first triangle exists
inline constexpr std::uint8_t second = 2;  // the second triangle exists
inline constexpr std::uint8_t anti = 4;    // cut along b-c
inline constexpr std::uint8_t used = 8;    // point a belongs to a triangle of this or another cell
inline constexpr std::uint8_t full = first | second;
}  // namespace cell

struct MeshOptions {
  // An edge between neighbouring pixels stands for a surface seen at no more than this angle to its normal; a
  // greater jump in depth is a discontinuity. Pixels are sampled up to 75 degrees or so.
  double max_incidence_deg = 82;
  // Jumps are allowed that many standard deviations of the two depths' difference more.
  double noise_sigmas = 3;
  // The area filter: a triangle's largest area, in half pixel footprints (1 for a surface facing the camera,
  // 1 / cos(incidence) for an inclined one).
  double max_area = 9;

  [[nodiscard]] Expected<void> check() const;
};

struct MeshReport {
  std::size_t edges_cut = 0;              // horizontal and vertical edges at depth discontinuities
  std::size_t faces_removed_by_area = 0;  // faces with three edges whose area is too large
};

// The cells of all points whose state is `kept`, of the grid's size (the last row and column stay empty). Of
// the two ways to cut a cell the one with more triangles is taken, then the one with the smaller jump in
// depth.
Image<std::uint8_t> connect_cells(const PointGrid& grid, const Image<PointState>& states, const Lens& camera,
                                  const MeshOptions& options, MeshReport& report);

}  // namespace bodyscan
