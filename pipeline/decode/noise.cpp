#include "pipeline/decode/noise.hpp"

#include "pipeline/decode/response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace bodyscan {
namespace {

constexpr int bins = 16;                    // of contrast
constexpr std::size_t min_bin_count = 200;  // samples for a median absolute deviation to be worth a point

// sRGB's mean slope, one grey level of quantisation and JPEG coding each in pattern and inverse.
constexpr float unmeasured_deviation = 1.4F * linear_full_scale / 255;

float robust_variance(std::vector<float>& departures) {
  const auto middle = departures.begin() + static_cast<std::ptrdiff_t>(departures.size() / 2);
  std::nth_element(departures.begin(), middle, departures.end());
  const float center = *middle;
  for (float& value : departures) value = std::abs(value - center);
  std::nth_element(departures.begin(), middle, departures.end());
  const float deviation = 1.4826F * *middle;
  return deviation * deviation / 4;  // of one difference; four went in
}

}  // namespace

NoiseModel measure_noise(const StripePlanes& planes, const Image<std::uint16_t>& contrast) {
  const NoiseModel unmeasured{unmeasured_deviation * unmeasured_deviation, 0};
  const auto& [first, second] = planes.plateau;
  if (first.empty() || first.size() != second.size()) return unmeasured;

  std::array<std::vector<float>, bins> departures;
  constexpr int step = StripePlanes::plateau_step;
  std::size_t i = 0;
  for (int y = 0; y < contrast.height(); y += step) {
    for (int x = 0; x < contrast.width(); x += step, ++i) {
      if (x == 0 || contrast(x, y) == 0 || contrast(x - step, y) == 0) continue;
      const auto bin = static_cast<std::size_t>(contrast(x, y) * bins / (linear_full_scale + 1));
      departures[bin].push_back(static_cast<float>((first[i] - second[i]) - (first[i - 1] - second[i - 1])));
    }
  }

  // Least squares of variance over contrast, weighted by the share of samples; both terms kept positive.
  double sw = 0;
  double sx = 0;
  double sy = 0;
  double sxx = 0;
  double sxy = 0;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    if (departures[bin].size() < min_bin_count) continue;
    const double x = (static_cast<double>(bin) + 0.5) * (linear_full_scale + 1) / bins;
    const double y = static_cast<double>(robust_variance(departures[bin]));
    const double w = static_cast<double>(departures[bin].size()) / (y * y + 1);
    sw += w;
    sx += w * x;
    sy += w * y;
    sxx += w * x * x;
    sxy += w * x * y;
  }
  if (sw == 0) return unmeasured;
  const double spread = sw * sxx - sx * sx;
  const double slope = spread > 1e-9 * sw * sxx ? std::max(0.0, (sw * sxy - sx * sy) / spread) : 0;
  const double constant = std::max((sy - slope * sx) / sw, 1.0);
  return {static_cast<float>(constant), static_cast<float>(slope)};
}

}  // namespace bodyscan
