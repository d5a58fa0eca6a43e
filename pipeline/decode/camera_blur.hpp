#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"
#include "pipeline/decode/correspondence.hpp"

#include <cstdint>

namespace bodyscan {

struct BrightnessEdgeLimits {
  float min_neighbour_share = 0.2F;  // of the brightest contrast within two pixels
  float max_gradient = 1;            // of contrast, in shares of the pixel's own a pixel

  [[nodiscard]] Expected<void> check() const;
};

// The camera's blur at brightness edges (the rim of a mole, a printed square, a silhouette): a pixel there
// sees the brighter side's stripes more than its own place's.
// - A pixel far darker than a neighbour, or in the middle of a steep edge, shows its neighbours' stripes, not
//   its own, and becomes undecided. The limits keep the rim of a dark mole (a third of the skin's
//   brightness).
// - Elsewhere, for a Gaussian blur of variance s^2 (px^2), the coordinate is off by s^2 grad(u) . grad(C) /
// C,
//   with u the coordinate and C the contrast as photographed. s^2 is measured on the capture, by regression
//   of the coordinate's second differences on those of that term, and the error is taken off.
// Returns s^2; 0, and nothing corrected, where the picture has too few brightness edges to tell.
float correct_camera_blur(AxisCorrespondence& axis, const Image<std::uint16_t>& contrast,
                          const BrightnessEdgeLimits& limits);

}  // namespace bodyscan
