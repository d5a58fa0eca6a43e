#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/surface/color.hpp"
#include "pipeline/surface/grid_mesh.hpp"

namespace bodyscan {

struct ShadedModelOptions {
  int max_width = 1400;   // px
  int max_height = 1050;  // px
  double turn_deg = 28;   // the model turns its left side (on the picture) to the viewer
  double tilt_deg = 14;   // and its top
  Rgb8 background{28, 31, 36};
};

// A picture of the model: turned a little, lit from the upper left beside the viewer, with its colours;
// parallel projection, as large as the limits allow. Vertices are averaged to about the picture's resolution
// first, which shows relief that single points' noise would cover. `colors` may be null (light grey); an
// empty mesh gives the empty background.
[[nodiscard]] ColorImage8 shaded_model(const GridMesh& mesh, const SurfaceColor* colors,
                                       const ShadedModelOptions& options = {});

}  // namespace bodyscan
