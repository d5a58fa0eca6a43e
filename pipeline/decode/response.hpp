#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/image/tone_response.hpp"

namespace bodyscan {

// Full scale of linear light in the decoder: differences of two values still fit 16 bits with their sign.
inline constexpr int linear_full_scale = 16383;

// Linear light, 0 to linear_full_scale, for every encoded value of `bits` (8 or 16) bits.
std::vector<std::uint16_t> linear_table(const ToneResponse& response, int bits);

}  // namespace bodyscan
