#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"
#include "pipeline/geometry/lens.hpp"
#include "pipeline/geometry/point_grid.hpp"

#include <cstddef>
#include <cstdint>

namespace bodyscan {

// Which single points are taken for artifacts. A footprint is the side of a pixel on a surface that faces the
// camera at the point's depth, mm.
struct CleanOptions {
  // A neighbour in the 5 x 5 window supports a point if the surface between them would be seen at no more
  // than this angle to its normal.
  double support_incidence_deg = 82;
  // A point with fewer of the 24 neighbours in its support is isolated. The corner of a surface has 8.
  int min_support = 8;
  // A point at which even the flattest of the four triangles with its direct neighbours is steeper than this
  // hangs between two surfaces. Surfaces up to 75 degrees are measured; the rest is room for noise.
  double flying_incidence_deg = 81;
  // A point is a spike if it stands out by more than this many footprints plus `spike_sigmas` of its own
  // uncertainty from every neighbour and from every line between two opposite neighbours.
  double spike_footprints = 1.5;
  double spike_sigmas = 5;
  // A point on the rim of a surface may lie that many footprints, plus `rim_sigmas` of the uncertainty of the
  // comparison, off the line through the two points behind it.
  double rim_footprints = 1;
  double rim_sigmas = 2;

  [[nodiscard]] Expected<void> check() const;
};

struct CleanReport {
  std::size_t points = 0;           // before cleaning
  std::size_t isolated_points = 0;  // removed: too little support
  std::size_t flying_pixels = 0;    // removed: between two surfaces, or out of the surface
};

// What `find_artifacts` says of a pixel.
enum class PointState : std::uint8_t { kept, absent, isolated, flying };

// Judges every point of the grid against its neighbours; the grid stays as it is. The answer has the grid's
// size; `report` is filled. The camera's distortion is left out of the footprint (a few per cent).
Image<PointState> find_artifacts(const PointGrid& grid, const Lens& camera, const CleanOptions& options,
                                 CleanReport& report);

}  // namespace bodyscan
