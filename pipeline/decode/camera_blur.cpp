#include "pipeline/decode/camera_blur.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace bodyscan {
namespace {

constexpr double max_blur = 1.5;           // px^2; beyond, something else than the lens bends the coordinate
constexpr float max_bend = 0.5F;           // projector px: a larger second difference is a jump
constexpr float min_sigma = 0.01F;         // projector px: no pixel counts for more than this
constexpr float min_pull_sigmas = 5;       // of the term's second difference
constexpr double min_significance = 5;     // standard errors
constexpr int stride = SampledRows::step;  // of second differences, px: the blur's own width and more
constexpr int rows_a_task = 32;

// Standard deviation of what a correction leaves, in shares of it: a lens is no Gaussian (measured on real
// pictures of a printed board, 0 to 1 px from its squares' edges).
constexpr float correction_doubt = 0.2F;

constexpr float max_unevenness = 0.15F;  // of an edge's bright side, in shares of the edge
constexpr int tail_px = 3;               // half the tail's reach

// A camera row of contrast and its neighbours.
struct ContrastRows {
  const std::uint16_t* far_above;
  const std::uint16_t* above;
  const std::uint16_t* here;
  const std::uint16_t* below;
  const std::uint16_t* far_below;
};

// grad(u) . grad(C) / C of one row, for the core and the tail.
struct EdgePull {
  BODYSCAN_KERNEL void run(int begin, int end, Gradient gradient, ContrastRows rows, float* core,
                           float* tail) {
    BODYSCAN_VECTORIZE
    for (int x = begin; x < end; ++x) {
      const float contrast = static_cast<float>(rows.here[x]);
      const float share = contrast > 0 ? 0.5F / (contrast > 1 ? contrast : 1) : 0;
      const float across = static_cast<float>(rows.here[x + 1]) - static_cast<float>(rows.here[x - 1]);
      const float down = static_cast<float>(rows.below[x]) - static_cast<float>(rows.above[x]);
      core[x] = share * (gradient.across * across + gradient.down * down);
      const float far_across =
          static_cast<float>(rows.here[x + tail_px]) - static_cast<float>(rows.here[x - tail_px]);
      const float far_down = static_cast<float>(rows.far_below[x]) - static_cast<float>(rows.far_above[x]);
      tail[x] = share / tail_px * (gradient.across * far_across + gradient.down * far_down);
    }
  }
};

// One row's terms, or several rows'.
struct Pull {
  explicit Pull(Size size) : core(size, 0), tail(size, 0) {}
  FloatImage core;
  FloatImage tail;

  // Row i becomes that of camera row y; the picture's border, which lacks neighbours, stays 0.
  void measure(int i, int y, const GradientMap& gradients, const Image<std::uint16_t>& contrast) {
    std::fill_n(core.row(i), core.width(), 0.0F);
    std::fill_n(tail.row(i), tail.width(), 0.0F);
    if (y < tail_px || y >= contrast.height() - tail_px) return;
    const ContrastRows rows{contrast.row(y - tail_px), contrast.row(y - 1), contrast.row(y),
                            contrast.row(y + 1), contrast.row(y + tail_px)};
    constexpr int block = GradientMap::block_px;
    for (int bx = 0; bx < gradients.columns(); ++bx)
      run_kernel<EdgePull>(std::max(tail_px, bx * block),
                           std::min((bx + 1) * block, contrast.width() - tail_px), gradients.of_block(bx, y),
                           rows, core.row(i), tail.row(i));
  }
};

struct TakeOff {
  BODYSCAN_KERNEL void run(int width, CameraBlur blur, const float* core, const float* tail, float* u,
                           float* sigma) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const float correction = blur.core * core[x] + blur.tail * tail[x];
      const float doubt = correction_doubt * correction;
      u[x] -= correction;
      sigma[x] = std::sqrt(sigma[x] * sigma[x] + doubt * doubt);
    }
  }
};

// Sums of a regression through the origin of b on core and tail.
struct Regression {
  double count = 0;
  double cc = 0;
  double ct = 0;
  double tt = 0;
  double cb = 0;
  double tb = 0;
  double bb = 0;

  void add(const Regression& other) {
    count += other.count;
    cc += other.cc;
    ct += other.ct;
    tt += other.tt;
    cb += other.cb;
    tb += other.tb;
    bb += other.bb;
  }

  // The core alone explains what it can, or both do; the tail only where it is significant and no negative.
  [[nodiscard]] CameraBlur solve() const {
    if (count < 2 || cc <= 0) return {};
    const double alone = cb / cc;
    const double alone_error = std::sqrt(std::max(0.0, bb - alone * cb) / (count - 1) / cc);
    if (alone <= 0 || alone < min_significance * alone_error || alone > max_blur) return {};
    const double determinant = cc * tt - ct * ct;
    if (count > 2 && determinant > 1e-6 * cc * tt) {
      const double core = (tt * cb - ct * tb) / determinant;
      const double tail = (cc * tb - ct * cb) / determinant;
      const double variance = std::max(0.0, bb - core * cb - tail * tb) / (count - 2);
      if (core > 0 && tail > min_significance * std::sqrt(variance * cc / determinant))
        return {static_cast<float>(core), static_cast<float>(tail)};
    }
    return {static_cast<float>(alone), 0};
  }
};

// The same, a column of the picture each.
struct ColumnSums {
  explicit ColumnSums(int width) : sums({width, 7}, 0) {}
  FloatImage sums;

  [[nodiscard]] Regression total() const {
    const auto sum = [&](int row) {
      return std::accumulate(sums.row(row), sums.row(row) + sums.width(), 0.0);
    };
    return {sum(0), sum(1), sum(2), sum(3), sum(4), sum(5), sum(6)};
  }
};

// Three values of a column or a row, `stride` px apart, at every x.
struct Triple {
  const float* before;
  const float* here;
  const float* after;

  // Of image row i, along it or across.
  static Triple of(const FloatImage& image, int i, bool across) {
    if (across) return {image.row(i) - stride, image.row(i), image.row(i) + stride};
    return {image.row(i - 1), image.row(i), image.row(i + 1)};
  }
};

// Contrast at every x and, along the same direction, one and two strides to both sides.
struct ContrastLine {
  const std::uint16_t* two_before;
  const std::uint16_t* before;
  const std::uint16_t* here;
  const std::uint16_t* after;
  const std::uint16_t* two_after;

  static ContrastLine of(const Image<std::uint16_t>& contrast, int y, bool across) {
    const auto at = [&](int strides) {
      return across ? contrast.row(y) + strides * stride : contrast.row(y + strides * stride);
    };
    return {at(-2), at(-1), at(0), at(1), at(2)};
  }
};

struct AddSecondDifferences {
  BODYSCAN_KERNEL void run(int begin, int end, Triple core, Triple tail, Triple u, const float* sigma,
                           ContrastLine contrast, float bright, NoiseModel noise, float slope2, float* sums,
                           std::ptrdiff_t width) {
    BODYSCAN_VECTORIZE
    for (int x = begin; x < end; ++x) {
      const float light = static_cast<float>(contrast.here[x]);
      // A painted edge has an even bright side; where a surface turns away, light goes on falling.
      const float before = static_cast<float>(contrast.before[x]);
      const float after = static_cast<float>(contrast.after[x]);
      const float beyond = after > before ? static_cast<float>(contrast.two_after[x]) - after
                                          : static_cast<float>(contrast.two_before[x]) - before;
      const bool even = std::abs(beyond) < max_unevenness * std::abs(after - before);
      const float c = core.before[x] - 2 * core.here[x] + core.after[x];
      const float t = tail.before[x] - 2 * tail.here[x] + tail.after[x];
      const float b = u.before[x] - 2 * u.here[x] + u.after[x];
      // Each term of c is half a difference of two contrasts: 1/2 (1 + 4 + 1) of one's variance.
      const float variance = 3 * slope2 * (noise.constant + noise.slope * light);
      const bool stands_out = c * c * light * light > min_pull_sigmas * min_pull_sigmas * variance;
      const bool counts = stands_out & even & (light >= bright) & (std::abs(b) < max_bend) &
                          (std::abs(c) < 4 * max_bend);  // NaN does not count
      const float weight = counts ? 1 / (sigma[x] * sigma[x] + min_sigma * min_sigma) : 0;
      const float safe_b = counts ? b : 0;
      sums[x] += counts ? 1 : 0;
      sums[x + width] += weight * c * c;
      sums[x + 2 * width] += weight * c * t;
      sums[x + 3 * width] += weight * t * t;
      sums[x + 4 * width] += weight * c * safe_b;
      sums[x + 5 * width] += weight * t * safe_b;
      sums[x + 6 * width] += weight * safe_b * safe_b;
    }
  }
};

// Row k of the sample, row i of the terms, along the image direction in which the coordinate changes faster:
// across it the terms are nothing but noise.
void add_row(const SampledRows& sampled, const GradientMap& gradients, const Image<std::uint16_t>& contrast,
             const NoiseModel& noise, int k, const Pull& pull, int i, ColumnSums& sums) {
  const FloatImage& u = sampled.values.coordinate;
  const int y = k * SampledRows::step;
  constexpr int block = GradientMap::block_px;
  for (int bx = 0; bx < gradients.columns(); ++bx) {
    const Gradient& gradient = gradients.of_block(bx, y);
    const bool across = std::abs(gradient.across) > std::abs(gradient.down);
    run_kernel<AddSecondDifferences>(
        std::max(2 * stride, bx * block), std::min((bx + 1) * block, u.width() - 2 * stride),
        Triple::of(pull.core, i, across), Triple::of(pull.tail, i, across), Triple::of(u, k, across),
        sampled.values.sigma.row(k), ContrastLine::of(contrast, y, across),
        static_cast<float>(gradients.bright()), noise,
        gradient.across * gradient.across + gradient.down * gradient.down, sums.sums.data(),
        std::ptrdiff_t{u.width()});
  }
}

}  // namespace

CameraBlur measure_camera_blur(const SampledRows& sampled, const GradientMap& gradients,
                               const Image<std::uint16_t>& contrast, const NoiseModel& noise) {
  const int rows = sampled.values.coordinate.height();
  if (rows < 5) return {};
  std::vector<Regression> tasks(static_cast<std::size_t>(rows / rows_a_task + 1));
  parallel_for(2, rows - 2, rows_a_task, [&](int first, int last) {
    Pull pull({contrast.width(), last - first + 2});
    for (int i = 0; i < last - first + 2; ++i)
      pull.measure(i, (first - 1 + i) * SampledRows::step, gradients, contrast);
    ColumnSums sums(contrast.width());
    for (int k = first; k < last; ++k)
      add_row(sampled, gradients, contrast, noise, k, pull, k - first + 1, sums);
    tasks[static_cast<std::size_t>((first - 2) / rows_a_task)] = sums.total();
  });
  Regression all;  // summed in order, so that the result does not depend on the threads
  for (const Regression& task : tasks) all.add(task);
  return all.solve();
}

void correct_camera_blur(const CameraBlur& blur, const GradientMap& gradients,
                         const Image<std::uint16_t>& contrast, const RowRange& rows,
                         const RowArrays& arrays) {
  if (blur.core == 0) return;
  const int width = contrast.width();
  Pull pull({width, 1});
  for (int i = 0; i < rows.count; ++i) {
    pull.measure(0, rows.camera_row(i), gradients, contrast);
    run_kernel<TakeOff>(width, blur, static_cast<const float*>(pull.core.data()),
                        static_cast<const float*>(pull.tail.data()), arrays.coordinate_row(i),
                        arrays.sigma_row(i));
  }
}

}  // namespace bodyscan
