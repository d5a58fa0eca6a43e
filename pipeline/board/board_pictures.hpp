#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/image/frame.hpp"

#include <string>

namespace bodyscan {

// The pictures that boards are looked for in: grey levels from 0 to full_scale.
constexpr float full_scale = 255;
constexpr float saturated = 254;
constexpr double overexposed_share = 0.25;  // of the pixels, saturated

// As the camera encoded them.
FloatImage encoded(const Luma& luma);

// Linear light under sRGB.
FloatImage linear(const Luma& luma);

// Means of factor x factor pixels.
FloatImage reduced(const FloatImage& image, int factor);

// later / earlier of linear light, up to 4, where there is light to compare; equal light gives
// same_light_level.
FloatImage ratio_of(const FloatImage& later, const FloatImage& earlier);
constexpr float max_ratio = 4;
constexpr float same_light_level = full_scale / max_ratio;

// How much a pixel of the ratio can be trusted, up to 1: its noise falls with the light it is relative to.
FloatImage trust_in(const FloatImage& earlier);

// What is wrong with a picture's light, for a message: " (too dark)"; empty for nothing.
std::string light_hint(const FloatImage& image);

}  // namespace bodyscan
