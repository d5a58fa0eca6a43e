#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/decode/coordinate_rows.hpp"
#include "pipeline/decode/correspondence.hpp"

namespace bodyscan {

struct LocalFitOptions {
  float half_width_px = 1;        // projector px the square reaches up and down; 0: no fit
  float max_half_width_px = 4;    // projector px it may grow to where noise demands
  float enough_sigma_px = 0.01F;  // projector px; a square need not grow once sigma is below

  [[nodiscard]] Expected<void> check() const;
};

// Gives each pixel the value there of a quadratic fitted to the square around it (Savitzky and Golay 1964, in
// both image directions): noise falls, planes and curvature stay. The square's size is given in projector
// pixels and grows only where the pixel's sigma asks for it, so good light keeps its relief. A square that
// holds undecided pixels, the picture's border or a jump is fitted to what it holds of the pixel's own
// surface; where that does not show one smooth surface, the pixel stands alone. sigma falls with the noise.
// `px_per_unit`: camera pixels a projector pixel. `fitted` has the camera's size; all of it is written.
void fit_locally(const CoordinateRows& raw, float px_per_unit, const LocalFitOptions& options,
                 AxisCorrespondence& fitted);

}  // namespace bodyscan
