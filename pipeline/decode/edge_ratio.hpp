#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/decode/noise.hpp"
#include "pipeline/decode/stripe_planes.hpp"

#include <cstdint>

namespace bodyscan {

// Between two neighbouring stripe edges two bits cross zero: the finest resolved one at one edge, a coarser
// one at the other. The ratio |fine| / (|fine| + |coarse|) of their differences runs from 0 at the fine bit's
// edge to 1 at the coarse bit's; albedo, distance and incidence cancel in it.
struct EdgeRatioLimits {
  float min_direct_share;     // as DecodeOptions
  float min_signal_to_noise;  // as DecodeOptions
  NoiseModel noise;
  int count;  // rows or columns of the projector
};

// One camera row, stripes of 2^dropped rows. ratio: NaN where undecided; cell: index of the stripe (the
// coordinate lies in [cell, cell + 1) * 2^dropped - 0.5); deviation: standard deviation of the ratio.
void measure_edge_ratio(const StripePlanes& planes, const Image<std::uint16_t>& contrast, int y, int dropped,
                        const EdgeRatioLimits& limits, float* ratio, std::uint16_t* cell, float* deviation);

}  // namespace bodyscan
