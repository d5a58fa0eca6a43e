#include "pipeline/decode/response.hpp"

#include "pipeline/image/srgb.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace bodyscan {
namespace {

double to_linear(const ToneResponse& response, double encoded) {
  switch (response.kind) {
    case ToneResponse::Kind::srgb:
      return srgb_to_linear(encoded);
    case ToneResponse::Kind::gamma:
      return std::pow(encoded, response.gamma);
    case ToneResponse::Kind::linear:
      break;
  }
  return encoded;
}

constexpr std::size_t min_samples = 300;
constexpr std::size_t most_looked_at = 4'000'000;  // pixels; a median needs no more
constexpr double srgb_tolerance = 0.1;             // of the sum of light; noise and JPEG stay below 0.03
constexpr double linear_tolerance = 0.05;          // of gamma

// Encoded values, 0 to 1, of one pixel.
struct Sample {
  double white;
  double black;
  double pattern;
  double inverse;

  // Light of pattern and inverse over light of white and black: 1 under the right response.
  [[nodiscard]] double sum_ratio(const ToneResponse& response) const {
    return (to_linear(response, pattern) + to_linear(response, inverse)) /
           (to_linear(response, white) + to_linear(response, black));
  }
};

template <class Pixel>
std::vector<Sample> edge_samples(const Image<Pixel>& white, const Image<Pixel>& black,
                                 const Image<Pixel>& pattern, const Image<Pixel>& inverse) {
  constexpr int full = std::numeric_limits<Pixel>::max();
  std::vector<Sample> samples;
  const std::size_t step = 1 + white.size().area() / most_looked_at;
  for (std::size_t i = 0; i < white.size().area(); i += step) {
    const int contrast = white.data()[i] - black.data()[i];
    const int difference = std::abs(pattern.data()[i] - inverse.data()[i]);
    if (contrast < full / 10 || white.data()[i] > full - full / 50 || 5 * difference > contrast) continue;
    const auto share = [](Pixel value) { return static_cast<double>(value) / full; };
    samples.push_back(
        {share(white.data()[i]), share(black.data()[i]), share(pattern.data()[i]), share(inverse.data()[i])});
  }
  return samples;
}

double median_ratio(const std::vector<Sample>& samples, const ToneResponse& response) {
  std::vector<double> ratios;
  ratios.reserve(samples.size());
  for (const Sample& sample : samples) ratios.push_back(sample.sum_ratio(response));
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

// The exponent under which the light adds up; the ratio falls with it.
ToneResponse fit_gamma(const std::vector<Sample>& samples) {
  double low = 0.3;
  double high = 5;
  while (high - low > 1e-3) {
    const double middle = (low + high) / 2;
    (median_ratio(samples, {ToneResponse::Kind::gamma, middle}) > 1 ? low : high) = middle;
  }
  const double gamma = (low + high) / 2;
  if (std::abs(gamma - 1) < linear_tolerance) return {ToneResponse::Kind::linear, 1};
  return {ToneResponse::Kind::gamma, gamma};
}

}  // namespace

ResponseTest test_response(const Luma& white, const Luma& black, const Luma& pattern, const Luma& inverse) {
  const std::vector<Sample> samples = std::visit(
      [&](const auto& w) {
        using Picture = std::decay_t<decltype(w)>;
        return edge_samples(w, std::get<Picture>(black), std::get<Picture>(pattern),
                            std::get<Picture>(inverse));
      },
      white);
  if (samples.size() < min_samples) return {};
  if (std::abs(median_ratio(samples, {}) - 1) < srgb_tolerance) return {samples.size(), {}};
  return {samples.size(), fit_gamma(samples)};
}

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
