#include "tools/evaluate/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace bodyscan {

double quantile(std::vector<float>& values, double fraction) {
  if (values.empty()) return 0;
  const double place = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), below, values.end());
  const double low = *below;
  const double weight = place - std::floor(place);
  if (weight == 0) return low;
  return low + weight * (*std::min_element(below + 1, values.end()) - low);
}

Statistics summarize(std::span<const float> signed_deviations) {
  Statistics result;
  result.count = signed_deviations.size();
  if (result.count == 0) return result;
  const double count = static_cast<double>(result.count);
  double sum = 0;
  double squares = 0;
  for (const float value : signed_deviations) {
    sum += value;
    squares += static_cast<double>(value) * value;
  }
  result.bias = sum / count;
  result.rms = std::sqrt(squares / count);

  std::vector<float> values(signed_deviations.begin(), signed_deviations.end());
  result.range_997 = -quantile(values, 0.0015);
  result.range_997 += quantile(values, 0.9985);
  const double median = quantile(values, 0.5);
  for (float& value : values) value = std::abs(value);
  result.p50 = quantile(values, 0.5);
  result.p95 = quantile(values, 0.95);
  result.p997 = quantile(values, 0.997);
  std::ranges::transform(signed_deviations, values.begin(),
                         [&](float value) { return static_cast<float>(std::abs(value - median)); });
  result.mad = quantile(values, 0.5);
  return result;
}

}  // namespace bodyscan
