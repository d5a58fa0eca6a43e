#pragma once

#include "pipeline/decode/correspondence.hpp"

namespace bodyscan {

// Replaces each coordinate by the value at its pixel of a quadratic fitted to the square around it (Savitzky and
// Golay 1964, in both image directions): noise falls, planes and curvature stay. The square reaches `half_width`
// projector px up and down, measured in camera pixels on the capture itself. Where it holds an undecided pixel or
// a jump, the largest smaller square without one is taken, at last the pixel alone. sigma falls with the noise.
AxisCorrespondence fit_locally(AxisCorrespondence raw, float half_width);

}  // namespace bodyscan
