#include "pipeline/decode/local_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"

namespace bodyscan {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();
constexpr int max_radius = 8;

// Second difference, in projector px, above which neighbours do not lie on one smooth surface; a bump of 0.5 mm
// on 2 mm makes 0.1 px at 3 camera px a mm.
constexpr float max_bend = 0.2F;
constexpr float max_bend_sigmas = 5;

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
  float gain = 0;  // variance of the middle value in units of one value's; in both directions: standard deviation
};

// A row without the pixels that bend too much; `above` and `below` are its neighbours.
struct KeepSmooth {
  BODYSCAN_KERNEL void run(int width, const float* above, const float* row, const float* below,
                           const float* sigma, float* kept) {
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
    for (int x = radius; x < width - radius; ++x) fitted[x] = 0;
    for (int i = -radius; i <= radius; ++i) {
      const float weight = weights[i + radius];
      for (int x = radius; x < width - radius; ++x) fitted[x] += weight * row[x + i];
    }
  }
};

struct AddWeighted {
  BODYSCAN_KERNEL void run(int width, float weight, const float* row, float* sum) {
    for (int x = 0; x < width; ++x) sum[x] += weight * row[x];
  }
};

struct TakeFitted {
  BODYSCAN_KERNEL void run(int width, float gain, const float* fitted, float* value, float* sigma) {
    for (int x = 0; x < width; ++x) {
      const bool known = fitted[x] == fitted[x];
      value[x] = known ? fitted[x] : value[x];
      sigma[x] = known ? gain * sigma[x] : sigma[x];
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

// Fits rows [first, last) of `raw` with one radius into `out`, whose values stay where the square is not whole.
void fit_rows(const AxisCorrespondence& raw, const Weights& weights, int first, int last, AxisCorrespondence& out) {
  const int width = raw.coordinate.width();
  const int height = raw.coordinate.height();
  const int r = weights.radius;
  const auto columns = static_cast<std::size_t>(width);
  std::vector<float> kept(columns, none);
  std::vector<float> across(columns * static_cast<std::size_t>(last - first + 2 * r), none);
  const auto across_row = [&](int y) { return across.data() + columns * static_cast<std::size_t>(y - first + r); };
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
    run_kernel<TakeFitted>(width, weights.gain, static_cast<const float*>(fitted.data()), out.coordinate.row(y),
                           out.sigma.row(y));
  }
}

}  // namespace

AxisCorrespondence fit_locally(AxisCorrespondence raw, float half_width) {
  const Size camera = raw.coordinate.size();
  const float radius_px = half_width * pixels_per_unit(raw.coordinate);
  const int radius = std::clamp(static_cast<int>(std::lround(radius_px)), 0, max_radius);
  if (radius < 2 || camera.width <= 2 * radius || camera.height <= 2 * radius) return raw;

  AxisCorrespondence fitted{raw.coordinate.clone(), raw.sigma.clone()};
  std::vector<Weights> sizes;
  for (int r = 2; r <= radius; r = std::max(r + 1, std::min(2 * r, radius))) sizes.emplace_back(r);
  parallel_for(0, camera.height, 64, [&](int first, int last) {
    AxisCorrespondence* out = &fitted;
    for (const Weights& weights : sizes) fit_rows(raw, weights, first, last, *out);
  });
  return fitted;
}

}  // namespace bodyscan
