#pragma once

#include "pipeline/decode/coordinate_rows.hpp"
#include "pipeline/decode/noise.hpp"
#include "pipeline/decode/phase_harmonic.hpp"
#include "pipeline/decode/phase_planes.hpp"
#include "pipeline/decode/stripe_amplitude.hpp"

namespace bodyscan {

// Makes the coordinate that a coarse Gray code gives (stripe_locator.hpp) finer by the phase of narrow
// stripes.
class PhaseLocator {
 public:
  // All but `noise`, of one picture's linear light, must outlive it.
  PhaseLocator(const PhasePlanes& planes, const StripeAmplitude& amplitude, const PhaseHarmonic& harmonic,
               const Image<std::uint16_t>& contrast, const NoiseModel& noise);

  // The arrays hold the Gray code's coordinates, as of StripeLocator.
  void refine(const RowRange& rows, const RowArrays& arrays) const;

 private:
  const PhasePlanes& planes_;
  const StripeAmplitude& amplitude_;
  const PhaseHarmonic& harmonic_;
  const Image<std::uint16_t>& contrast_;
  NoiseModel noise_;
};

}  // namespace bodyscan
