#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"
#include "pipeline/decode/coordinate_rows.hpp"

#include <cstdint>

namespace bodyscan {

struct BrightnessEdgeLimits {
  float min_neighbour_share = 0.2F;  // of the brightest contrast within two pixels
  float max_gradient = 1;            // of contrast, in shares of the pixel's own a pixel

  [[nodiscard]] Expected<void> check() const;
};

// A pixel far darker than a neighbour, or in the middle of a steep brightness edge, shows its neighbours'
// stripes through the camera's blur, not its own, and becomes undecided (NaN). The limits keep the rim of a
// dark mole (a third of the skin's brightness).
void drop_outshone(const Image<std::uint16_t>& contrast, const BrightnessEdgeLimits& limits,
                   const RowRange& rows, const RowArrays& arrays);

}  // namespace bodyscan
