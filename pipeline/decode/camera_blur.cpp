#include "pipeline/decode/camera_blur.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <cmath>
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

// grad(u) . grad(C) / C of one row, and its variance for contrasts of variance `noise`.
struct EdgePull {
  BODYSCAN_KERNEL void run(int begin, int end, Gradient gradient, const std::uint16_t* above,
                           const std::uint16_t* here, const std::uint16_t* below, float* pull) {
    BODYSCAN_VECTORIZE
    for (int x = begin; x < end; ++x) {
      const float contrast = static_cast<float>(here[x]);
      const float across = static_cast<float>(here[x + 1]) - static_cast<float>(here[x - 1]);
      const float down = static_cast<float>(below[x]) - static_cast<float>(above[x]);
      const float product = gradient.across * across + gradient.down * down;
      pull[x] = contrast > 0 ? 0.5F * product / (contrast > 1 ? contrast : 1) : 0;
    }
  }
};

// The picture's border, which lacks a neighbour, gets 0.
void edge_pull_row(const GradientMap& gradients, const Image<std::uint16_t>& contrast, int y, float* pull) {
  const int width = contrast.width();
  if (y < 1 || y >= contrast.height() - 1 || width < 3) {
    std::fill_n(pull, width, 0.0F);
    return;
  }
  pull[0] = 0;
  pull[width - 1] = 0;
  constexpr int block = GradientMap::block_px;
  for (int bx = 0; bx < gradients.columns(); ++bx)
    run_kernel<EdgePull>(std::max(1, bx * block), std::min((bx + 1) * block, width - 1),
                         gradients.of_block(bx, y), contrast.row(y - 1), contrast.row(y), contrast.row(y + 1),
                         pull);
}

struct TakeOff {
  BODYSCAN_KERNEL void run(int width, float blur, const float* pull, float* u, float* sigma) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const float correction = blur * pull[x];
      const float doubt = correction_doubt * correction;
      u[x] -= correction;
      sigma[x] = std::sqrt(sigma[x] * sigma[x] + doubt * doubt);
    }
  }
};

// Sums of a regression through the origin of b on a.
struct Regression {
  double count = 0;
  double aa = 0;
  double ab = 0;
  double bb = 0;

  void add(const Regression& other) {
    count += other.count;
    aa += other.aa;
    ab += other.ab;
    bb += other.bb;
  }
  [[nodiscard]] double slope() const { return aa > 0 ? ab / aa : 0; }
  [[nodiscard]] double standard_error() const {
    return aa > 0 && count > 1 ? std::sqrt(std::max(0.0, bb - slope() * ab) / (count - 1) / aa) : 0;
  }
};

// The same, a column of the picture each.
struct ColumnSums {
  explicit ColumnSums(int width)
      : count(static_cast<std::size_t>(width), 0), aa(count), ab(count), bb(count) {}
  std::vector<float> count;
  std::vector<float> aa;
  std::vector<float> ab;
  std::vector<float> bb;

  [[nodiscard]] Regression total() const {
    Regression sum;
    for (std::size_t x = 0; x < count.size(); ++x)
      sum.add({static_cast<double>(count[x]), static_cast<double>(aa[x]), static_cast<double>(ab[x]),
               static_cast<double>(bb[x])});
    return sum;
  }
};

// Three values of a column or a row, `stride` px apart, at every x.
struct Triple {
  const float* before;
  const float* here;
  const float* after;
};

struct AddSecondDifferences {
  BODYSCAN_KERNEL void run(int begin, int end, Triple pull, Triple u, const float* sigma,
                           const std::uint16_t* contrast, float bright, NoiseModel noise, float slope2,
                           float* count, float* aa, float* ab, float* bb) {
    BODYSCAN_VECTORIZE
    for (int x = begin; x < end; ++x) {
      const float light = static_cast<float>(contrast[x]);
      const float a = pull.before[x] - 2 * pull.here[x] + pull.after[x];
      const float b = u.before[x] - 2 * u.here[x] + u.after[x];
      // Each term is half a difference of two contrasts: 1/2 (1 + 4 + 1) of one's variance.
      const float variance = 3 * slope2 * (noise.constant + noise.slope * light);
      const bool stands_out = a * a * light * light > min_pull_sigmas * min_pull_sigmas * variance;
      const bool counts = stands_out & (light >= bright) & (std::abs(b) < max_bend) &
                          (std::abs(a) < 4 * max_bend);  // NaN does not count
      const float weight = counts ? 1 / (sigma[x] * sigma[x] + min_sigma * min_sigma) : 0;
      const float safe_b = counts ? b : 0;
      count[x] += counts ? 1 : 0;
      aa[x] += weight * a * a;
      ab[x] += weight * a * safe_b;
      bb[x] += weight * safe_b * safe_b;
    }
  }
};

// Along the image direction in which the coordinate changes faster: across it the term is nothing but noise.
void add_row(const SampledRows& sampled, const GradientMap& gradients, const Image<std::uint16_t>& contrast,
             const NoiseModel& noise, int k, const Triple& pull, ColumnSums& sums) {
  const FloatImage& u = sampled.values.coordinate;
  const int y = k * SampledRows::step;
  constexpr int block = GradientMap::block_px;
  for (int bx = 0; bx < gradients.columns(); ++bx) {
    const Gradient& gradient = gradients.of_block(bx, y);
    const bool across = std::abs(gradient.across) > std::abs(gradient.down);
    const Triple term = across ? Triple{pull.here - stride, pull.here, pull.here + stride} : pull;
    const Triple value = across ? Triple{u.row(k) - stride, u.row(k), u.row(k) + stride}
                                : Triple{u.row(k - 1), u.row(k), u.row(k + 1)};
    run_kernel<AddSecondDifferences>(
        std::max(stride, bx * block), std::min((bx + 1) * block, u.width() - stride), term, value,
        sampled.values.sigma.row(k), contrast.row(y), static_cast<float>(gradients.bright()), noise,
        gradient.across * gradient.across + gradient.down * gradient.down, sums.count.data(), sums.aa.data(),
        sums.ab.data(), sums.bb.data());
  }
}

}  // namespace

float measure_camera_blur(const SampledRows& sampled, const GradientMap& gradients,
                          const Image<std::uint16_t>& contrast, const NoiseModel& noise) {
  const int rows = sampled.values.coordinate.height();
  if (rows < 3) return 0;
  std::vector<Regression> tasks(static_cast<std::size_t>(rows / rows_a_task + 1));
  parallel_for(1, rows - 1, rows_a_task, [&](int first, int last) {
    FloatImage pull({contrast.width(), last - first + 2});
    for (int i = 0; i < pull.height(); ++i)
      edge_pull_row(gradients, contrast, (first - 1 + i) * SampledRows::step, pull.row(i));
    ColumnSums sums(contrast.width());
    for (int k = first; k < last; ++k) {
      const int i = k - first + 1;
      add_row(sampled, gradients, contrast, noise, k, {pull.row(i - 1), pull.row(i), pull.row(i + 1)}, sums);
    }
    tasks[static_cast<std::size_t>((first - 1) / rows_a_task)] = sums.total();
  });
  Regression fit;  // summed in order, so that the result does not depend on the threads
  for (const Regression& task : tasks) fit.add(task);
  const bool told = fit.slope() > 0 && fit.slope() >= min_significance * fit.standard_error();
  return told && fit.slope() <= max_blur ? static_cast<float>(fit.slope()) : 0;
}

void correct_camera_blur(float blur, const GradientMap& gradients, const Image<std::uint16_t>& contrast,
                         const RowRange& rows, const RowArrays& arrays) {
  if (blur == 0) return;
  const int width = contrast.width();
  std::vector<float> pull(static_cast<std::size_t>(width));
  for (int i = 0; i < rows.count; ++i) {
    edge_pull_row(gradients, contrast, rows.camera_row(i), pull.data());
    run_kernel<TakeOff>(width, blur, static_cast<const float*>(pull.data()), arrays.coordinate_row(i),
                        arrays.sigma_row(i));
  }
}

}  // namespace bodyscan
