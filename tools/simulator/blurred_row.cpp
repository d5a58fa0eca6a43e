#include "tools/simulator/blurred_row.hpp"

#include <algorithm>
#include <cmath>

namespace bodyscan::simulator {
namespace {

// What a pixel's box of unit light gives at `distance` from its centre after a Gaussian blur.
double blurred_box(double distance, double sigma) {
  if (sigma <= 0) return std::abs(distance) < 0.5 ? 1 : std::abs(distance) == 0.5 ? 0.5 : 0;
  const double scale = 1 / (sigma * std::sqrt(2.0));
  return 0.5 * (std::erf((distance + 0.5) * scale) - std::erf((distance - 0.5) * scale));
}

// A row of pixels, blurred, at `count` positions `1 / samples` px apart from -margin on.
std::vector<float> blurred(const std::vector<float>& pixels, double sigma, int samples, int margin,
                           int count) {
  const int reach = static_cast<int>(std::ceil(6 * sigma)) + 1;
  const int taps = 2 * reach + 1;
  std::vector<double> weights(static_cast<std::size_t>(samples * taps));
  for (int phase = 0; phase < samples; ++phase) {
    for (int tap = 0; tap < taps; ++tap)
      weights[static_cast<std::size_t>(phase * taps + tap)] =
          blurred_box(static_cast<double>(phase) / samples - (tap - reach), sigma);
  }
  const int last = static_cast<int>(pixels.size()) - 1;
  std::vector<float> result(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const int pixel = i / samples - margin;
    const double* weight = &weights[static_cast<std::size_t>(i % samples * taps)];
    double sum = 0;
    for (int tap = 0; tap < taps; ++tap)
      sum += weight[tap] *
             static_cast<double>(pixels[static_cast<std::size_t>(std::clamp(pixel + tap - reach, 0, last))]);
    result[static_cast<std::size_t>(i)] = static_cast<float>(sum);
  }
  return result;
}

}  // namespace

BlurredRow::BlurredRow(const std::vector<float>& pixels, double defocus, double scattered) {
  constexpr int samples = static_cast<int>(samples_per_px);
  constexpr int before = static_cast<int>(margin);
  const int count = (static_cast<int>(pixels.size()) + 2 * before) * samples + 1;
  const std::vector<float> sharp = blurred(pixels, defocus, samples, before, count);
  const std::vector<float> soft =
      scattered > defocus ? blurred(pixels, scattered, samples, before, count) : sharp;
  table_.reserve(sharp.size());
  for (std::size_t i = 0; i < sharp.size(); ++i) table_.push_back({sharp[i], soft[i] - sharp[i]});
}

}  // namespace bodyscan::simulator
