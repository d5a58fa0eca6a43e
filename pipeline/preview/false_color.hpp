#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/surface/grid_mesh.hpp"

namespace bodyscan {

// Pictures for people: numbers as colours from green (least) over cyan to blue (most), black where there is
// none. Reduced by a whole factor to at most `max_width` columns, each pixel the mean of those it stands for.

// The depth of the mesh's vertices, from the nearest to the furthest per cent of them.
[[nodiscard]] ColorImage8 depth_picture(const GridMesh& mesh, int max_width = 1600);

// Projector coordinates (NaN: none) between 0 and `count` - 1; `coordinate` is on the camera's pixel grid.
[[nodiscard]] ColorImage8 coordinate_picture(const FloatImage& coordinate, int count, int max_width = 1600);

}  // namespace bodyscan
