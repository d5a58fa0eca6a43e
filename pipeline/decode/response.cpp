#include "pipeline/decode/response.hpp"

#include <cmath>

namespace bodyscan {
namespace {

// IEC 61966-2-1, 5.2.
double srgb_to_linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double to_linear(const ToneResponse& response, double encoded) {
  switch (response.kind) {
    case ToneResponse::Kind::srgb: return srgb_to_linear(encoded);
    case ToneResponse::Kind::gamma: return std::pow(encoded, response.gamma);
    case ToneResponse::Kind::linear: break;
  }
  return encoded;
}

}  // namespace

std::vector<std::uint16_t> linear_table(const ToneResponse& response, int bits) {
  const std::size_t count = std::size_t{1} << bits;
  std::vector<std::uint16_t> table(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double encoded = static_cast<double>(i) / static_cast<double>(count - 1);
    table[i] = static_cast<std::uint16_t>(std::lround(linear_full_scale * to_linear(response, encoded)));
  }
  return table;
}

}  // namespace bodyscan
