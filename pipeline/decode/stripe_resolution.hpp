#pragma once

#include <cstdint>

#include "pipeline/base/image.hpp"
#include "pipeline/decode/stripe_planes.hpp"

namespace bodyscan {

// How many of the finest bits the optics no longer resolve, block by block.
struct StripeResolution {
  static constexpr int block_px = 16;

  Image<std::uint8_t> dropped;  // a value a block of block_px x block_px camera pixels

  [[nodiscard]] int at(int x, int y) const { return dropped(x / block_px, y / block_px); }
};

// Defocus and subsurface scattering wash stripes out, the finest first. A bit is dropped where the mean size of
// its difference falls below half of that of the next coarser bit: from there on the coarser stripes' edges,
// though twice as far apart, place a pixel better (their slope at the middle between two edges exceeds that of
// the finer bit at its own edge).
StripeResolution find_stripe_resolution(const StripePlanes& planes, const Image<std::uint16_t>& contrast,
                                        int max_dropped_bits);

}  // namespace bodyscan
