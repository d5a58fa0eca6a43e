#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/decode/correspondence.hpp"

namespace bodyscan {

struct LocalFitOptions {
  float half_width_px = 1;        // projector px the square reaches up and down; 0: no fit
  float max_half_width_px = 4;    // projector px it may grow to where noise demands
  float enough_sigma_px = 0.01F;  // projector px; a square need not grow once sigma is below

  [[nodiscard]] Expected<void> check() const;
};

// Replaces each coordinate by the value at its pixel of a quadratic fitted to the square around it (Savitzky
// and Golay 1964, in both image directions): noise falls, planes and curvature stay. The square's size is
// measured in camera pixels on the capture itself and grows only where the pixel's sigma asks for it, so good
// light keeps its relief. A square that holds an undecided pixel or a jump is not used: the largest without
// one is, at last the pixel alone. sigma falls with the noise.
AxisCorrespondence fit_locally(AxisCorrespondence raw, const LocalFitOptions& options);

}  // namespace bodyscan
