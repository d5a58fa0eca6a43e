#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/model/mesh.hpp"
#include "pipeline/surface/color.hpp"
#include "pipeline/surface/grid_mesh.hpp"

namespace bodyscan {

struct SimplifyOptions {
  // No vertex of the full mesh lies further from the simplified surface: mm.
  double max_error_mm = 0.05;
  // No vertex's colour differs more from the one interpolated at its pixel, in any channel: sRGB levels. The
  // white frame's noise is about 1 level (22,000 electrons full well), a mole's edge 30 and more.
  double max_color_error = 10;

  [[nodiscard]] Expected<void> check() const;
};

// A mesh with fewer faces: a right-triangulated irregular network on the pixel grid (Evans, Kirkpatrick and
// Townsend 2001), split wherever one of the vertices a triangle covers breaks a bound. It has no cracks; the
// outline and the rims of holes keep every vertex. `colors` may be null: then the result has no colours and
// only the geometric bound holds. Vertices keep the raster order. Takes 5 bytes a pixel, 3 more for colours,
// beside the result. Error: an option out of its range.
[[nodiscard]] Expected<Mesh> simplify(const GridMesh& mesh, const SurfaceColor* colors,
                                      const SimplifyOptions& options);

}  // namespace bodyscan
