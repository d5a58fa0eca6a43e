#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"
#include "pipeline/geometry/lens.hpp"
#include "pipeline/geometry/point_grid.hpp"

#include <cstddef>
#include <cstdint>

namespace bodyscan {

struct ComponentOptions {
  // A connected piece of surface that covers less than this, seen from the camera, is removed: mm^2. Measured
  // in area so that it means the same at every resolution: 25 mm^2 are 900 pixels of a D5000 at 1.05 m.
  double min_component_mm2 = 25;
  // But an island stays: a small piece that, along most of the rows, goes on from a large one at the same
  // depth (63 degrees) across a gap of no more than this. The inside of a mole is one when its rim is not
  // decoded.
  double island_gap_mm = 5;

  [[nodiscard]] Expected<void> check() const;
};

struct ComponentReport {
  std::size_t components = 0;              // kept
  std::size_t small_components = 0;        // removed
  std::size_t small_component_points = 0;  // their points
};

// Removes the triangles of small components from the cells of `grid` (cells.hpp).
void remove_small_components(const PointGrid& grid, const Lens& camera, const ComponentOptions& options,
                             Image<std::uint8_t>& cells, ComponentReport& report);

}  // namespace bodyscan
