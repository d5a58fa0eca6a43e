#include "tools/simulator/sensor.hpp"

#include <algorithm>
#include <cmath>

namespace bodyscan::simulator {
namespace {

constexpr std::size_t table_size = 1 << 16;

std::uint64_t scramble(std::uint64_t x) {  // splitmix64's finaliser (Steele 2014)
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

// The normal distribution's quantiles at (i + 1/2) / 65536, scaled to unit variance.
const std::vector<float>& gauss_table() {
  static const std::vector<float> table = [] {
    std::vector<float> values(table_size);
    double x = 0;
    double squares = 0;
    for (std::size_t i = table_size / 2; i < table_size; ++i) {
      const double wanted = (static_cast<double>(i) + 0.5) / table_size;
      for (int step = 0; step < 20; ++step) {
        const double error = 0.5 * std::erfc(-x / std::sqrt(2.0)) - wanted;
        x -= error / (std::exp(-x * x / 2) / std::sqrt(2 * 3.14159265358979323846));
        if (std::abs(error) < 1e-14) break;
      }
      values[i] = static_cast<float>(x);
      squares += 2 * x * x;
    }
    const auto scale = static_cast<float>(std::sqrt(table_size / squares));
    for (std::size_t i = table_size / 2; i < table_size; ++i) {
      values[i] *= scale;
      values[table_size - 1 - i] = -values[i];
    }
    return values;
  }();
  return table;
}

const std::vector<std::uint8_t>& code_table() {
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> codes(table_size);
    for (std::size_t i = 0; i < table_size; ++i)
      codes[i] = static_cast<std::uint8_t>(
          std::lround(255 * linear_to_srgb(static_cast<double>(i) / (table_size - 1))));
    return codes;
  }();
  return table;
}

}  // namespace

Sensor::Sensor(double full_well, double read_noise, std::uint64_t seed, std::uint64_t frame)
    : full_well_(static_cast<float>(full_well)),
      read_variance_(static_cast<float>(read_noise * read_noise)),
      key_(scramble(scramble(seed + 0x9E3779B97F4A7C15ULL) + frame * 0xD1342543DE82EF95ULL)),
      gauss_(&gauss_table()),
      codes_(&code_table()) {
  dark_.reserve(table_size);
  for (const float gauss : *gauss_) dark_.push_back(code(0, gauss));
}

std::uint8_t Sensor::code(float light, float gauss) const {
  float signal = light;
  if (full_well_ > 0) {
    const float electrons = light * full_well_;
    signal = (electrons + std::sqrt(electrons + read_variance_) * gauss) / full_well_;
  }
  return (*codes_)[static_cast<std::size_t>(std::clamp(signal, 0.0F, 1.0F) * (table_size - 1) + 0.5F)];
}

std::array<std::uint8_t, 3> Sensor::expose(const std::array<float, 3>& light, std::uint64_t pixel) const {
  const std::uint64_t random = scramble(key_ + pixel * 0x9E3779B97F4A7C15ULL);
  const std::array<std::size_t, 3> draw{random & 0xFFFF, (random >> 16) & 0xFFFF, (random >> 32) & 0xFFFF};
  std::array<std::uint8_t, 3> codes;
  for (unsigned c = 0; c < 3; ++c)
    codes[c] = light[c] > 0 ? code(light[c], (*gauss_)[draw[c]]) : dark_[draw[c]];
  return codes;
}

}  // namespace bodyscan::simulator
