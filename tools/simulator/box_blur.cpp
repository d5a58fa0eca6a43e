#include "tools/simulator/box_blur.hpp"

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

}  // namespace

BoxBlur::BoxBlur(double sigma, int samples, int margin) : samples_(samples), margin_(margin) {
  const int reach = static_cast<int>(std::ceil(6 * sigma)) + 1;
  taps_ = 2 * reach + 1;
  weights_.reserve(static_cast<std::size_t>(samples * taps_));
  for (int phase = 0; phase < samples; ++phase) {
    for (int tap = 0; tap < taps_; ++tap)
      weights_.push_back(blurred_box(static_cast<double>(phase) / samples - (tap - reach), sigma));
  }
}

std::vector<float> BoxBlur::blur(std::span<const float> pixels) const {
  const int last = static_cast<int>(pixels.size()) - 1;
  std::vector<float> result(static_cast<std::size_t>(count(last + 1)));
  for (int i = 0; i < static_cast<int>(result.size()); ++i) {
    int pixel = first_pixel(i);
    double sum = 0;
    for (const double weight : weights(i))
      sum += weight * static_cast<double>(pixels[static_cast<std::size_t>(std::clamp(pixel++, 0, last))]);
    result[static_cast<std::size_t>(i)] = static_cast<float>(sum);
  }
  return result;
}

}  // namespace bodyscan::simulator
