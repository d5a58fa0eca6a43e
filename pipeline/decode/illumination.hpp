#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/image/frame.hpp"

#include <cstdint>
#include <span>

namespace bodyscan {

// What the white and the black frame say about each pixel.
struct Illumination {
  Image<std::uint16_t>
      contrast;                // white minus black in linear light; 0 where the projector's light is missing
  std::size_t pixels_lit = 0;  // pixels whose contrast is not 0
};

// A pixel is lit where white exceeds black by `min_contrast` grey levels of 255 as photographed. Input
// errors: the white frame is darker than the black one; nothing is lit.
Expected<Illumination> measure_illumination(const Luma& white, const Luma& black, float min_contrast,
                                            std::span<const std::uint16_t> linear);

}  // namespace bodyscan
