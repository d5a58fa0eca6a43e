#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/decode/local_fit.hpp"
#include "pipeline/decode/outshone.hpp"
#include "pipeline/image/tone_response.hpp"

#include <optional>

namespace bodyscan {

struct DecodeOptions {
  std::optional<ToneResponse> response;  // nothing: sRGB, unless the frames contradict it
  float min_contrast = 5;                // grey levels of 255, white minus black: a pixel below is not lit
  float min_direct_share =
      0.06F;  // of white minus black: a pixel whose stripes vary less sees scattered light
  float min_signal_to_noise = 3;  // of the stripes' difference: a pixel below is undecided
  int max_dropped_bits = 2;       // finest bits given up where the optics no longer resolve them, 0 to 2
  BrightnessEdgeLimits brightness_edges;
  LocalFitOptions fit;

  [[nodiscard]] Expected<void> check() const;
};

}  // namespace bodyscan
