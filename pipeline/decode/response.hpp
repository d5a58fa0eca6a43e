#pragma once

#include "pipeline/image/frame.hpp"
#include "pipeline/image/tone_response.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace bodyscan {

// Full scale of linear light in the decoder: differences of two values still fit 16 bits with their sign.
inline constexpr int linear_full_scale = 16383;

// Linear light, 0 to linear_full_scale, for every encoded value of `bits` (8 or 16) bits.
std::vector<std::uint16_t> linear_table(const ToneResponse& response, int bits);

// Whether the frames contradict sRGB, and what they say instead. Light adds up: pattern plus inverse is white
// plus black at every pixel, which tests the response where a stripe's edge leaves pattern and inverse about
// equal. Nothing where sRGB fits or where too few pixels (no edge on the subject) could tell; all four of one
// size and depth.
struct ResponseTest {
  std::size_t samples = 0;              // pixels that could tell
  std::optional<ToneResponse> instead;  // of sRGB
};
ResponseTest test_response(const Luma& white, const Luma& black, const Luma& pattern, const Luma& inverse);

}  // namespace bodyscan
