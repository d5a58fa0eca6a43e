#include "pipeline/decode/local_fit.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace bodyscan {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();
constexpr int max_radius = 12;

// Second difference, in projector px, above which neighbours do not lie on one smooth surface; a bump of 0.5
// mm on 2 mm makes 0.1 px at 3 camera px a mm.
constexpr float max_bend = 0.2F;
constexpr float max_bend_sigmas =
    12;  // five of a second difference, whose deviation is sqrt(6) times a value's

// Weights of the value at the middle of a quadratic fitted to 2 radius + 1 equidistant values.
struct Weights {
  explicit Weights(int r) : radius(r) {
    const double n = 2 * r + 1;
    const double s2 = r * (r + 1.0) * n / 3;
    const double s4 = s2 * (3.0 * r * r + 3.0 * r - 1) / 5;
    for (int i = -r; i <= r; ++i) {
      const double weight = (s4 - s2 * i * i) / (n * s4 - s2 * s2);
      at[static_cast<std::size_t>(i + r)] = static_cast<float>(weight);
      gain += static_cast<float>(weight * weight);
    }
  }
  int radius;
  std::array<float, 2 * max_radius + 1> at{};
  float gain =
      0;  // variance of the middle value in units of one value's; in both directions: standard deviation
};

// A row without the pixels that bend too much; `above` and `below` are its neighbours.
struct KeepSmooth {
  BODYSCAN_KERNEL void run(int width, const float* above, const float* row, const float* below,
                           const float* sigma, float* kept) {
    BODYSCAN_VECTORIZE
    for (int x = 1; x < width - 1; ++x) {
      const float across = std::abs(row[x - 1] - 2 * row[x] + row[x + 1]);
      const float along = std::abs(above[x] - 2 * row[x] + below[x]);
      const float limit = max_bend + max_bend_sigmas * sigma[x];
      kept[x] = (across < limit) & (along < limit) ? row[x] : none;
    }
  }
};

struct FitAcross {
  BODYSCAN_KERNEL void run(int width, int radius, const float* weights, const float* row, float* fitted) {
    BODYSCAN_VECTORIZE
    for (int x = radius; x < width - radius; ++x) fitted[x] = 0;
    for (int i = -radius; i <= radius; ++i) {
      const float weight = weights[i + radius];
      BODYSCAN_VECTORIZE
      for (int x = radius; x < width - radius; ++x) fitted[x] += weight * row[x + i];
    }
  }
};

struct AddWeighted {
  BODYSCAN_KERNEL void run(int width, float weight, const float* row, float* sum) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) sum[x] += weight * row[x];
  }
};

// Takes a larger square's value where the smaller one's sigma, `gain_before` times the raw one, is too large.
struct TakeFitted {
  BODYSCAN_KERNEL void run(int width, float gain, float gain_before, float enough, const float* fitted,
                           const float* raw_sigma, float* value, float* sigma) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const bool take = (fitted[x] == fitted[x]) & (gain_before * raw_sigma[x] > enough);
      value[x] = take ? fitted[x] : value[x];
      sigma[x] = take ? gain * raw_sigma[x] : sigma[x];
    }
  }
};

// Camera pixels a projector pixel, along the steeper image direction; median over the picture.
float pixels_per_unit(const FloatImage& coordinate) {
  std::vector<float> slopes;
  for (int y = 2; y < coordinate.height() - 2; y += 5) {
    for (int x = 2; x < coordinate.width() - 2; x += 5) {
      const float across = std::abs(coordinate(x + 2, y) - coordinate(x - 2, y)) / 4;
      const float down = std::abs(coordinate(x, y + 2) - coordinate(x, y - 2)) / 4;
      if (across + down > 0) slopes.push_back(std::max(across, down));
    }
  }
  if (slopes.empty()) return 0;
  const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
  std::nth_element(slopes.begin(), middle, slopes.end());
  return 1 / std::max(*middle, 1e-3F);
}

bool any_above(const AxisCorrespondence& raw, int first, int last, float sigma) {
  for (int y = first; y < last; ++y) {
    const float* coordinate = raw.coordinate.row(y);
    const float* deviation = raw.sigma.row(y);
    for (int x = 0; x < raw.coordinate.width(); ++x)
      if (coordinate[x] == coordinate[x] && deviation[x] > sigma) return true;
  }
  return false;
}

// Fits rows [first, last) of `raw` with one radius into `out`, whose values stay where the square is not
// whole or not needed: where gain_before times the raw sigma is `enough`.
void fit_rows(const AxisCorrespondence& raw, const Weights& weights, float gain_before, float enough,
              int first, int last, AxisCorrespondence& out) {
  const int width = raw.coordinate.width();
  const int height = raw.coordinate.height();
  const int r = weights.radius;
  const auto columns = static_cast<std::size_t>(width);
  std::vector<float> kept(columns, none);
  std::vector<float> across(columns * static_cast<std::size_t>(last - first + 2 * r), none);
  const auto across_row = [&](int y) {
    return across.data() + columns * static_cast<std::size_t>(y - first + r);
  };
  for (int y = std::max(1, first - r); y < std::min(height - 1, last + r); ++y) {
    run_kernel<KeepSmooth>(width, raw.coordinate.row(y - 1), raw.coordinate.row(y), raw.coordinate.row(y + 1),
                           raw.sigma.row(y), kept.data());
    run_kernel<FitAcross>(width, r, static_cast<const float*>(weights.at.data()),
                          static_cast<const float*>(kept.data()), across_row(y));
  }
  std::vector<float> fitted(columns);
  for (int y = first; y < last; ++y) {
    std::fill(fitted.begin(), fitted.end(), 0.0F);
    for (int i = -r; i <= r; ++i)
      run_kernel<AddWeighted>(width, weights.at[static_cast<std::size_t>(i + r)],
                              static_cast<const float*>(across_row(y + i)), fitted.data());
    run_kernel<TakeFitted>(width, weights.gain, gain_before, enough, static_cast<const float*>(fitted.data()),
                           raw.sigma.row(y), out.coordinate.row(y), out.sigma.row(y));
  }
}

// The radii tried, ascending; those above the wanted one only where noise demands.
std::vector<Weights> make_sizes(const LocalFitOptions& options, float px_per_unit) {
  const auto radius = [&](float half_width) {
    return std::clamp(static_cast<int>(std::lround(half_width * px_per_unit)), 0, max_radius);
  };
  const int wanted = radius(options.half_width_px);
  const int largest = radius(options.max_half_width_px);
  std::vector<Weights> sizes;
  for (int r = 2; r <= largest; r += r < wanted || r < 4 ? 1 : 2) sizes.emplace_back(r);
  return sizes;
}

}  // namespace

Expected<void> LocalFitOptions::check() const {
  if (!(half_width_px >= 0 && half_width_px <= max_half_width_px && max_half_width_px <= 20))
    return tl::unexpected(
        Error{ErrorKind::usage, "the local fit's half width must lie in 0 to its maximum, that in 0 to 20"});
  if (!(enough_sigma_px >= 0))
    return tl::unexpected(Error{ErrorKind::usage, "enough_sigma_px must not be negative"});
  return {};
}

AxisCorrespondence fit_locally(AxisCorrespondence raw, const LocalFitOptions& options) {
  const Size camera = raw.coordinate.size();
  if (options.half_width_px == 0) return raw;
  const float px_per_unit = pixels_per_unit(raw.coordinate);
  const std::vector<Weights> sizes = make_sizes(options, px_per_unit);
  if (sizes.empty() || std::min(camera.width, camera.height) <= 2 * sizes.back().radius) return raw;
  const float wanted_radius = options.half_width_px * px_per_unit;

  AxisCorrespondence fitted{raw.coordinate.clone(), raw.sigma.clone()};
  parallel_for(0, camera.height, 64, [&](int first, int last) {
    float gain_before = 1;
    for (const Weights& weights : sizes) {
      const bool wanted = static_cast<float>(weights.radius) <= std::max(2.0F, wanted_radius + 0.5F);
      const float enough = wanted ? 0 : options.enough_sigma_px;
      if (!any_above(raw, first, last, enough / gain_before)) break;
      fit_rows(raw, weights, gain_before, enough, first, last, fitted);
      gain_before = weights.gain;
    }
  });
  return fitted;
}

}  // namespace bodyscan
