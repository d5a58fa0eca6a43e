#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/decode/stripe_planes.hpp"

#include <cstdint>

namespace bodyscan {

// Variance of a difference pattern minus inverse, in squared units of linear light, as a line over the
// pixel's contrast: read noise and quantisation, then shot noise.
struct NoiseModel {
  float constant = 0;
  float slope = 0;

  [[nodiscard]] float variance(float contrast) const { return constant + slope * contrast; }
};

// Measured on the capture itself: far from an edge the two coarsest bits differ from their inverses by the
// same amount, up to scattered light, which varies slowly. What is left of that between neighbouring samples
// is noise (median absolute deviation, so that pixels near an edge do not count). `contrast` as of
// Illumination.
NoiseModel measure_noise(const StripePlanes& planes, const Image<std::uint16_t>& contrast);

}  // namespace bodyscan
