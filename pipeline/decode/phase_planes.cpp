#include "pipeline/decode/phase_planes.hpp"

#include "pipeline/base/parallel.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace bodyscan {
namespace {

// A step's share of a sum, for every encoded value: no partial sum exceeds 2 / pi of full scale.
template <class Value>
std::vector<Value> shares(std::span<const std::uint16_t> linear, double weight) {
  std::vector<Value> table;
  table.reserve(linear.size());
  for (const std::uint16_t light : linear) table.push_back(static_cast<Value>(std::lround(weight * light)));
  return table;
}

template <class Pixel, class Value>
void add_shares(int width, const Pixel* picture, const Value* table, Value* sum) {
  for (int x = 0; x < width; ++x) sum[x] = static_cast<Value>(sum[x] + table[picture[x]]);
}

}  // namespace

PhasePlanes::PhasePlanes(Size camera, const PhaseCode& code)
    : code_(code), cosine_(camera, 0), sine_(camera, 0), twice_mean_(camera, 0) {}

void PhasePlanes::add(int step, const Luma& picture, std::span<const std::uint16_t> linear) {
  const double angle = 2 * std::numbers::pi * step / code_.steps;
  const auto cosine_shares = shares<std::int16_t>(linear, 2 * std::cos(angle) / code_.steps);
  const auto sine_shares = shares<std::int16_t>(linear, 2 * std::sin(angle) / code_.steps);
  const auto mean_shares = shares<std::uint16_t>(linear, 2.0 / code_.steps);
  std::visit(
      [&](const auto& pixels) {
        parallel_for(0, pixels.height(), 64, [&](int first, int last) {
          for (int y = first; y < last; ++y) {
            add_shares(pixels.width(), pixels.row(y), cosine_shares.data(), cosine_.row(y));
            add_shares(pixels.width(), pixels.row(y), sine_shares.data(), sine_.row(y));
            add_shares(pixels.width(), pixels.row(y), mean_shares.data(), twice_mean_.row(y));
          }
        });
      },
      picture);
}

}  // namespace bodyscan
