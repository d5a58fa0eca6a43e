#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/decode/phase_planes.hpp"

#include <cstdint>
#include <vector>

namespace bodyscan {

// The N-th power of every pixel's unit vector (cosine, sine): of N times its phase.
struct PhasePower {
  explicit PhasePower(int width) : cosine(static_cast<std::size_t>(width)), sine(cosine.size()) {}

  // Of camera row y, N the number of steps.
  void measure(const PhasePlanes& planes, int y);

  std::vector<float> cosine;
  std::vector<float> sine;

 private:
  std::vector<float> unit_cosine_;
  std::vector<float> unit_sine_;
};

// Stripes are no cosine: N steps take their harmonics N - 1 and N + 1 for the first one, which moves a phase
// by a sin(N phase). How much is left of them depends on the optics, so a is measured on the capture, tile by
// tile: over a surface that crosses many stripes every phase is as frequent as any other, and the mean of
// cos(N phase measured) is -N a / 2.
class PhaseHarmonic {
 public:
  static constexpr int tile_px = 32;

  // `contrast` as of Illumination.
  PhaseHarmonic(const PhasePlanes& planes, const Image<std::uint16_t>& contrast);

  // a at each pixel of camera row y, radians, bilinear between tiles.
  void of_row(int y, std::vector<float>& harmonic) const;

 private:
  FloatImage tiles_;
};

}  // namespace bodyscan
