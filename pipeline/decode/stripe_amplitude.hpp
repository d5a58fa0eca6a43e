#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/decode/noise.hpp"
#include "pipeline/decode/phase_planes.hpp"

#include <cstdint>

namespace bodyscan {

// How strongly the stripes of the phase steps show around each place of the picture: their amplitude in
// shares of the contrast (white minus black), root mean square over blocks of lit pixels and their
// neighbours.
class StripeAmplitude {
 public:
  static constexpr int block_px = 16;

  // `contrast` as of Illumination.
  StripeAmplitude(const PhasePlanes& planes, const Image<std::uint16_t>& contrast);

  // Squared shares at every pixel of camera row y, the noise of one picture taken off.
  void squares_of_row(int y, const NoiseModel& noise, int width, float* squares) const;

 private:
  struct Block {
    float squares = 0;  // of amplitudes
    float contrast_squares = 0;
    float contrast = 0;
    float pixels = 0;
  };
  Image<Block> blocks_;  // sums over the block and its neighbours
  int steps_;
};

}  // namespace bodyscan
