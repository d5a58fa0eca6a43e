#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/image/frame.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace bodyscan {

// What the decoder keeps of one axis's bits, a fixed number of bytes a pixel however many frames come.
// Differences are pattern minus inverse in linear light (linear_full_scale), so that their sign is the bit.
struct StripePlanes {
  static constexpr int fine_bits = 3;

  // Bits below `finest_bit` do not come and take no memory.
  StripePlanes(Size camera, int bit_count, int finest_bit = 0);

  int bit_count = 0;
  Image<std::uint16_t> gray;                        // Gray code, a bit set where the pattern beat its inverse
  std::array<Image<std::int16_t>, fine_bits> fine;  // difference of bits 0, 1, 2
  Image<std::uint16_t> coarse;                      // smallest |difference| of bits 3 and up
  std::array<std::vector<std::uint16_t>, 2> plateau;  // |difference| of the two coarsest bits, every
  static constexpr int plateau_step = 4;  // plateau_step-th pixel both ways: they measure the noise

  // Takes bit `bit` in, coarsest first: both pictures as photographed, `linear` as of linear_table.
  void add(int bit, const Luma& pattern, const Luma& inverse, std::span<const std::uint16_t> linear);

  // The same for a sequence without inverses: `middle` is the sum of white and black in linear light.
  void add_against(int bit, const Luma& pattern, const Image<std::uint16_t>& middle,
                   std::span<const std::uint16_t> linear);

  // Takes the differences so far over to another response, given the contrasts under the old one and the new.
  // Zero crossings stay; the noise samples start afresh with the next bits.
  void rescale(const Image<std::uint16_t>& before, const Image<std::uint16_t>& now);

 private:
  template <class Subtract>
  void add_rows(int bit, const Subtract& subtract);
  std::vector<std::uint16_t>* plateau_to_fill();
};

}  // namespace bodyscan
