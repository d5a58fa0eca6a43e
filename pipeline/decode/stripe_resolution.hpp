#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/decode/noise.hpp"
#include "pipeline/decode/stripe_planes.hpp"

#include <array>
#include <cstdint>

namespace bodyscan {

// How many of the finest bits the optics no longer resolve, block by block.
struct StripeResolution {
  static constexpr int block_px = 16;

  Image<std::uint8_t> dropped;  // a value a block of block_px x block_px camera pixels

  [[nodiscard]] int at(int x, int y) const { return dropped(x / block_px, y / block_px); }
};

// The same number of bits everywhere.
StripeResolution uniform_resolution(Size camera, int dropped);

// How strongly stripes show, block by block: energies of the fine bits' differences over lit pixels, bit by
// bit as they come, then of white minus black, which stands for all bits beyond.
class StripeEnergy {
 public:
  StripeEnergy(const Image<std::uint16_t>& contrast, const NoiseModel& noise);

  // Bit 0, 1 or 2; each once.
  void add(int bit, const Image<std::int16_t>& difference, const Image<std::uint16_t>& contrast);

  // Defocus and subsurface scattering wash stripes out, the finest first. With amplitudes a0, a1, a2, ... of
  // the bits' differences (root mean square, noise taken off), stripes of bit k place a pixel with a variance
  // of about 4^k (1 / a_k^2 + 4 / a_(k+1)^2), since a stripe's far edge belongs to a coarser bit of twice its
  // period or more. Bit k is therefore dropped where a_k < a_(k+2) / 4.
  [[nodiscard]] StripeResolution resolve(int bit_count, int max_dropped_bits) const;

 private:
  struct Block {
    std::array<float, StripePlanes::fine_bits + 1> squares{};
    float noise = 0;
  };
  [[nodiscard]] Block sum_around(int bx, int by) const;

  Image<Block> blocks_;
};

}  // namespace bodyscan
