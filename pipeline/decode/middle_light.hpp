#pragma once

#include "pipeline/decode/phase_planes.hpp"

#include <cstdint>
#include <span>

namespace bodyscan {

// The light half way between white and black, which bits without inverses are told from.
class MiddleLight {
 public:
  MiddleLight() = default;
  MiddleLight(const Luma& white, const Luma& black, std::span<const std::uint16_t> linear);

  // Every row is lit in the same share of all phase steps, so their mean is a second, less noisy measurement.
  // Takes the steps' mean from them; `contrast` as of Illumination.
  void refine(PhasePlanes& steps, const Image<std::uint16_t>& contrast);

  // White plus black in linear light.
  [[nodiscard]] const Image<std::uint16_t>& twice() const { return twice_; }
  // Variance of that in units of one picture's.
  [[nodiscard]] float variance() const { return variance_; }

 private:
  Image<std::uint16_t> twice_;
  float variance_ = 2;
};

}  // namespace bodyscan
