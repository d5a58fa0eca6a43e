#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/image/frame.hpp"
#include "pipeline/pattern/sequence.hpp"

#include <cstdint>
#include <span>
#include <utility>

namespace bodyscan {

// What the decoder keeps of one axis's phase steps, however many come: with I_k the linear light
// (linear_full_scale) of step k of N,
//   cosine = 2 / N sum I_k cos(2 pi k / N),  sine = 2 / N sum I_k sin(2 pi k / N),
// whose angle is the phase and whose length is the stripes' amplitude, half their swing. Their mean is the
// light of a uniform grey, until it is taken.
class PhasePlanes {
 public:
  PhasePlanes(Size camera, const PhaseCode& code);

  // Each step once, in any order; `linear` as of linear_table.
  void add(int step, const Luma& picture, std::span<const std::uint16_t> linear);

  // Twice the mean of the steps, after the last one; once.
  [[nodiscard]] Image<std::uint16_t> take_twice_mean() { return std::move(twice_mean_); }

  [[nodiscard]] const PhaseCode& code() const { return code_; }
  [[nodiscard]] const Image<std::int16_t>& cosine() const { return cosine_; }
  [[nodiscard]] const Image<std::int16_t>& sine() const { return sine_; }

 private:
  PhaseCode code_;
  Image<std::int16_t> cosine_;
  Image<std::int16_t> sine_;
  Image<std::uint16_t> twice_mean_;
};

}  // namespace bodyscan
