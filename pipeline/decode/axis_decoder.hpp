#pragma once

#include "pipeline/decode/coordinate_gradient.hpp"
#include "pipeline/decode/correspondence.hpp"
#include "pipeline/decode/decode_options.hpp"
#include "pipeline/decode/illumination.hpp"
#include "pipeline/decode/middle_light.hpp"
#include "pipeline/decode/noise.hpp"
#include "pipeline/decode/phase_harmonic.hpp"
#include "pipeline/decode/phase_planes.hpp"
#include "pipeline/decode/stripe_amplitude.hpp"
#include "pipeline/decode/stripe_planes.hpp"
#include "pipeline/decode/stripe_resolution.hpp"

#include <optional>
#include <span>

namespace bodyscan {

// One axis of a sequence, from its bits as they come to where every pixel lies. What does not need the finest
// bit is measured before it, and all large memory is taken at the start, so that little is left to do after
// the last frame.
class AxisDecoder {
 public:
  // `count`: the projector's rows or columns; `phase`: of a sequence that has phase steps.
  AxisDecoder(Size camera, int count, const std::optional<PhaseCode>& phase);

  // Takes a phase step in; all of them come before the bits. The last one refines `middle`.
  void add_step(int step, const Luma& picture, std::span<const std::uint16_t> linear,
                const Illumination& light, MiddleLight& middle);

  // Takes bit `bit` in, coarsest first, as of StripePlanes.
  void add(int bit, const Luma& pattern, const Luma& inverse, std::span<const std::uint16_t> linear,
           const Illumination& light);
  void add_against(int bit, const Luma& pattern, const MiddleLight& middle,
                   std::span<const std::uint16_t> linear, const Illumination& light);
  // As of StripePlanes; `now` is what `light` holds from here on.
  void rescale(const Image<std::uint16_t>& before, const Image<std::uint16_t>& now);

  [[nodiscard]] bool complete() const { return complete_; }
  // Once, when complete: the correspondence; gives all memory away.
  AxisCorrespondence finish(const Illumination& light, const DecodeOptions& options);

 private:
  void taken(int bit, const Illumination& light);
  void measure_coarser_bits(const Illumination& light);

  [[nodiscard]] int finest_bit() const { return phase_ ? phase_->code().finest_bit : 0; }
  [[nodiscard]] StripeResolution resolve(const Illumination& light, const DecodeOptions& options);

  int count_;
  bool complete_ = false;
  std::optional<PhasePlanes> phase_;
  std::optional<StripeAmplitude> amplitude_;
  std::optional<PhaseHarmonic> harmonic_;
  float middle_variance_ = 2;  // as of MiddleLight
  std::optional<StripePlanes> planes_;
  NoiseModel noise_;
  std::optional<StripeEnergy> energy_;
  std::optional<SampledRows> sampled_;
  AxisCorrespondence result_;
};

}  // namespace bodyscan
