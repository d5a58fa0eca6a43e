#include "pipeline/decode/local_fit.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/decode/weighted_fit.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace bodyscan {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();
constexpr int max_radius = 12;
constexpr int band_rows = 128;  // rows a task measures and fits
constexpr int tile_columns = 128;
constexpr int tile_rows = 64;
constexpr float min_sigma = 0.01F;  // projector px: no value weighs more than one of this sigma
constexpr float noisy = 2;          // times enough_sigma_px: whole squares do no longer do

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

// Weights of a row's pixels for a weighted fit: the same, but a pixel whose neighbours do not tell counts.
struct WeighUsable {
  BODYSCAN_KERNEL void run(int width, const float* above, const float* row, const float* below,
                           const float* sigma, float* weight) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const float across = std::abs(row[x - 1] - 2 * row[x] + row[x + 1]);
      const float along = std::abs(above[x] - 2 * row[x] + below[x]);
      const float limit = max_bend + max_bend_sigmas * sigma[x];
      const bool bends = (across >= limit) | (along >= limit);
      const float variance = sigma[x] * sigma[x] + min_sigma * min_sigma;
      weight[x] = (row[x] == row[x]) & !bends ? 1 / variance : 0;
    }
  }
};

struct TakeLarger {
  BODYSCAN_KERNEL void run(int width, const float* coordinate, const float* sigma, float* largest) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const float value = coordinate[x] == coordinate[x] ? sigma[x] : 0;
      largest[x] = value > largest[x] ? value : largest[x];
    }
  }
};

struct FitAcross {
  BODYSCAN_KERNEL void run(int width, int radius, const float* weights, const float* row, const float* sigma,
                           float* fitted, float* variance) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      fitted[x] = 0;
      variance[x] = 0;
    }
    for (int i = -radius; i <= radius; ++i) {
      const float weight = weights[i + radius];
      BODYSCAN_VECTORIZE
      for (int x = 0; x < width; ++x) {
        const float weighted_sigma = weight * sigma[x + i];
        fitted[x] += weight * row[x + i];
        variance[x] += weighted_sigma * weighted_sigma;
      }
    }
  }
};

struct AddWeighted {
  BODYSCAN_KERNEL void run(int width, float weight, const float* row, const float* row_variance, float* sum,
                           float* variance) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      sum[x] += weight * row[x];
      variance[x] += weight * weight * row_variance[x];
    }
  }
};

// Takes a larger square's value where the sigma so far is too large.
struct TakeFitted {
  BODYSCAN_KERNEL void run(int width, float enough, const float* fitted, const float* variance, float* value,
                           float* sigma) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const float smaller = std::sqrt(variance[x]);
      const bool take = (fitted[x] == fitted[x]) & (sigma[x] > enough) & (smaller < sigma[x]);
      value[x] = take ? fitted[x] : value[x];
      sigma[x] = take ? smaller : sigma[x];
    }
  }
};

// At most band_rows camera rows of the raw correspondence with what lies around them, undecided beyond the
// picture.
class Band {
 public:
  Band(Size camera, int margin)
      : camera_(camera),
        margin_(margin),
        coordinate_({camera.width + 2 * margin, band_rows + 2 * margin}, none),
        sigma_(coordinate_.size(), 0),
        smooth_(coordinate_.size(), none) {}

  // Camera rows [first, last).
  void load(const CoordinateRows& raw, int first, int last) {
    top_ = first - margin_;
    const int begin = std::max(0, top_);
    const int end = std::min(camera_.height, last + margin_);
    raw({begin, end - begin},
        {coordinate_.row(begin - top_) + margin_, sigma_.row(begin - top_) + margin_, coordinate_.width()});
    for (int i = 0; i < coordinate_.height(); ++i)
      if (top_ + i < begin || top_ + i >= end) std::fill_n(coordinate_.row(i), coordinate_.width(), none);
    for (int i = 1; i + 1 < coordinate_.height(); ++i)
      run_kernel<KeepSmooth>(coordinate_.width(), static_cast<const float*>(coordinate_.row(i - 1)),
                             static_cast<const float*>(coordinate_.row(i)),
                             static_cast<const float*>(coordinate_.row(i + 1)),
                             static_cast<const float*>(sigma_.row(i)), smooth_.row(i));
  }

  // From camera column 0 of camera row y.
  [[nodiscard]] const float* coordinate(int y) const { return coordinate_.row(y - top_) + margin_; }
  [[nodiscard]] const float* sigma(int y) const { return sigma_.row(y - top_) + margin_; }
  [[nodiscard]] const float* smooth(int y) const { return smooth_.row(y - top_) + margin_; }
  [[nodiscard]] std::ptrdiff_t stride() const { return coordinate_.width(); }

 private:
  Size camera_;
  int margin_;
  int top_ = 0;
  FloatImage coordinate_;
  FloatImage sigma_;
  FloatImage smooth_;
};

struct Tile {
  int left;
  int right;
  int top;
  int bottom;
};

// Of the tile's decided pixels.
float largest_sigma(const AxisCorrespondence& axis, const Tile& tile) {
  std::vector<float> largest(static_cast<std::size_t>(tile.right - tile.left), 0);
  for (int y = tile.top; y < tile.bottom; ++y)
    run_kernel<TakeLarger>(tile.right - tile.left, axis.coordinate.row(y) + tile.left,
                           axis.sigma.row(y) + tile.left, largest.data());
  return *std::ranges::max_element(largest);
}

// Fits a tile with one radius into `out`, whose values stay where the square is not whole or sigma is
// `enough`.
void fit_whole_squares(const Band& raw, const Tile& tile, const Weights& weights, float enough,
                       AxisCorrespondence& out) {
  const int r = weights.radius;
  const int width = tile.right - tile.left;
  FloatImage across({width, tile.bottom - tile.top + 2 * r});
  FloatImage across_variance(across.size());
  for (int i = 0; i < across.height(); ++i) {
    const int y = tile.top - r + i;
    run_kernel<FitAcross>(width, r, static_cast<const float*>(weights.at.data()), raw.smooth(y) + tile.left,
                          raw.sigma(y) + tile.left, across.row(i), across_variance.row(i));
  }
  std::vector<float> fitted(static_cast<std::size_t>(width));
  std::vector<float> variance(fitted.size());
  for (int y = tile.top; y < tile.bottom; ++y) {
    std::ranges::fill(fitted, 0.0F);
    std::ranges::fill(variance, 0.0F);
    for (int i = 0; i <= 2 * r; ++i) {
      const int row = y - tile.top + i;
      run_kernel<AddWeighted>(
          width, weights.at[static_cast<std::size_t>(i)], static_cast<const float*>(across.row(row)),
          static_cast<const float*>(across_variance.row(row)), fitted.data(), variance.data());
    }
    run_kernel<TakeFitted>(width, enough, static_cast<const float*>(fitted.data()),
                           static_cast<const float*>(variance.data()), out.coordinate.row(y) + tile.left,
                           out.sigma.row(y) + tile.left);
  }
}

// Weighted fits of single pixels of a tile.
class WeightedTile {
 public:
  WeightedTile(const Band& raw, const Tile& tile, int margin)
      : raw_(raw),
        left_(tile.left - margin),
        top_(tile.top - margin),
        weight_({tile.right - tile.left + 2 * margin, tile.bottom - tile.top + 2 * margin}) {
    for (int i = 0; i < weight_.height(); ++i)
      run_kernel<WeighUsable>(weight_.width(), raw.coordinate(top_ + i - 1) + left_,
                              raw.coordinate(top_ + i) + left_, raw.coordinate(top_ + i + 1) + left_,
                              raw.sigma(top_ + i) + left_, weight_.row(i));
  }

  [[nodiscard]] WeightedSquare square(int x, int y, int radius) const {
    return {raw_.coordinate(y) + x, raw_.stride(), weight_.row(y - top_) + x - left_, weight_.width(),
            radius};
  }

 private:
  const Band& raw_;
  int left_;
  int top_;
  FloatImage weight_;
};

// From the size that would do if the square were whole, up until it does, else down.
void fit_weighted_square(const WeightedTile& tile, std::span<const Weights> sizes, int x, int y, float enough,
                         AxisCorrespondence& out) {
  float& sigma = out.sigma(x, y);
  const auto likely =
      std::ranges::find_if(sizes, [&](const Weights& weights) { return weights.gain * sigma <= enough; });
  const auto first = likely == sizes.end() ? std::prev(likely) : likely;
  bool taken = false;
  const auto take = [&](int radius) {
    const auto fit = fit_weighted(tile.square(x, y, radius));
    if (!fit || fit->sigma >= sigma) return;
    out.coordinate(x, y) = fit->value;
    sigma = fit->sigma;
    taken = true;
  };
  for (auto size = first; size != sizes.end() && !(taken && sigma <= enough); ++size) take(size->radius);
  for (auto size = first; !taken && size != sizes.begin();) take((--size)->radius);
}

// The pixels that no whole square was found for, and those that are noisy all the same: where values differ
// in sigma, weights make more of them.
void fit_weighted_squares(const Band& raw, const Tile& tile, std::span<const Weights> sizes, float enough,
                          AxisCorrespondence& out) {
  const auto too_large = std::ranges::find_if(
      sizes, [](const Weights& weights) { return weights.radius > WeightedSquare::max_radius; });
  const std::span<const Weights> fitting(sizes.begin(), too_large);
  if (fitting.empty()) return;
  std::optional<WeightedTile> weighted;  // made where it is needed
  for (int y = tile.top; y < tile.bottom; ++y) {
    const float* coordinate = raw.coordinate(y);
    const float* sigma = raw.sigma(y);
    const float* fitted = out.sigma.row(y);
    for (int x = tile.left; x < tile.right; ++x) {
      const bool alone = !(fitted[x] < sigma[x]);
      if (coordinate[x] != coordinate[x] || !(alone || fitted[x] > noisy * enough)) continue;
      if (!weighted) weighted.emplace(raw, tile, fitting.back().radius);
      if (*weighted->square(x, y, 0).weight > 0) fit_weighted_square(*weighted, fitting, x, y, enough, out);
    }
  }
}

void fit_tile(const Band& raw, const Tile& tile, std::span<const Weights> sizes, float enough,
              AxisCorrespondence& out) {
  for (int y = tile.top; y < tile.bottom; ++y) {
    std::copy(raw.coordinate(y) + tile.left, raw.coordinate(y) + tile.right,
              out.coordinate.row(y) + tile.left);
    std::copy(raw.sigma(y) + tile.left, raw.sigma(y) + tile.right, out.sigma.row(y) + tile.left);
  }
  for (const Weights& weights : sizes) {
    const float limit = &weights == &sizes.front() ? 0 : enough;
    if (largest_sigma(out, tile) <= limit) break;
    fit_whole_squares(raw, tile, weights, limit, out);
  }
  fit_weighted_squares(raw, tile, sizes, enough, out);
}

// The radii tried, ascending; those after the first only where noise demands.
std::vector<Weights> make_sizes(const LocalFitOptions& options, float px_per_unit) {
  const auto radius = [&](float half_width) {
    return std::clamp(static_cast<int>(std::lround(half_width * px_per_unit)), 0, max_radius);
  };
  const int largest = radius(options.max_half_width_px);
  std::vector<Weights> sizes;
  for (int r = std::max(2, radius(options.half_width_px)); r <= largest; r += r < 4 ? 1 : 2)
    sizes.emplace_back(r);
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

void fit_locally(const CoordinateRows& raw, float px_per_unit, const LocalFitOptions& options,
                 AxisCorrespondence& fitted) {
  const Size camera = fitted.coordinate.size();
  const std::vector<Weights> sizes =
      options.half_width_px > 0 ? make_sizes(options, px_per_unit) : std::vector<Weights>();
  if (sizes.empty()) {
    parallel_for(0, camera.height, band_rows, [&](int first, int last) {
      raw({first, last - first}, {fitted.coordinate.row(first), fitted.sigma.row(first), camera.width});
    });
    return;
  }
  // A thread takes band after band, in memory it allocates once.
  std::atomic<int> next = 0;
  parallel_for(0, thread_count(), 1, [&](int, int) {
    std::optional<Band> band;
    for (int first = 0; (first = next.fetch_add(band_rows)) < camera.height;) {
      const int last = std::min(first + band_rows, camera.height);
      if (!band) band.emplace(camera, sizes.back().radius + 1);
      band->load(raw, first, last);
      for (int top = first; top < last; top += tile_rows)
        for (int left = 0; left < camera.width; left += tile_columns)
          fit_tile(*band,
                   {left, std::min(left + tile_columns, camera.width), top, std::min(top + tile_rows, last)},
                   sizes, options.enough_sigma_px, fitted);
    }
  });
}

}  // namespace bodyscan
