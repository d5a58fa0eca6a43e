#include "pipeline/decode/camera_blur.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace bodyscan {
namespace {

constexpr double max_blur = 1.5;        // px^2; beyond, something else than the lens bends the coordinate
constexpr float max_bend = 0.5F;        // projector px: a larger second difference is a jump
constexpr float min_sigma = 0.01F;      // projector px: no pixel counts for more than this
constexpr float bright_share = 0.25F;   // of the 95th percentile of contrast: a pixel below has no say
constexpr double min_significance = 5;  // standard errors
constexpr int rows_a_task = 32;
constexpr int block_px = 32;
constexpr float max_slope = 4;  // projector px a camera px

struct Gradient {
  float across = 0;
  float down = 0;
};

// Contrast of a pixel that has a say; from every 16th pixel.
std::uint16_t bright_level(const Image<std::uint16_t>& contrast) {
  std::vector<std::uint16_t> lit;
  for (std::size_t i = 0; i < contrast.size().area(); i += 16)
    if (contrast.data()[i] > 0) lit.push_back(contrast.data()[i]);
  if (lit.empty()) return 0;
  const auto high = lit.begin() + static_cast<std::ptrdiff_t>(lit.size() * 95 / 100);
  std::nth_element(lit.begin(), high, lit.end());
  return static_cast<std::uint16_t>(bright_share * static_cast<float>(*high));
}

// The largest of the pixel and two neighbours on each side, `stride` apart; beyond the border counts as dark.
struct Brightest {
  BODYSCAN_KERNEL void run(int width, const std::uint16_t* two_before, const std::uint16_t* before,
                           const std::uint16_t* here, const std::uint16_t* after,
                           const std::uint16_t* two_after, std::uint16_t* brightest) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const std::uint16_t near = std::max(std::max(before[x], after[x]), here[x]);
      brightest[x] = std::max(std::max(two_before[x], two_after[x]), near);
    }
  }
};

struct DropOutshone {
  BODYSCAN_KERNEL void run(int width, float min_share, float max_gradient, const std::uint16_t* above,
                           const std::uint16_t* contrast, const std::uint16_t* below,
                           const std::uint16_t* brightest, float* u) {
    BODYSCAN_VECTORIZE
    for (int x = 1; x < width - 1; ++x) {
      const float own = static_cast<float>(contrast[x]);
      const float across = static_cast<float>(contrast[x + 1]) - static_cast<float>(contrast[x - 1]);
      const float down = static_cast<float>(below[x]) - static_cast<float>(above[x]);
      const float limit = 2 * max_gradient * own;
      const bool mixed = across * across + down * down > limit * limit;
      const bool outshone = own < min_share * static_cast<float>(brightest[x]);
      u[x] = mixed | outshone ? std::numeric_limits<float>::quiet_NaN() : u[x];
    }
  }
};

void drop_outshone(FloatImage& u, const Image<std::uint16_t>& contrast, const BrightnessEdgeLimits& limits) {
  const int width = contrast.width();
  parallel_for(0, contrast.height(), rows_a_task, [&](int first, int last) {
    // Two dark pixels beyond both ends.
    std::vector<std::uint16_t> down(static_cast<std::size_t>(width) + 4, 0);
    std::vector<std::uint16_t> brightest(static_cast<std::size_t>(width));
    for (int y = first; y < last; ++y) {
      const auto row = [&](int offset) {
        return contrast.row(std::clamp(y + offset, 0, contrast.height() - 1));
      };
      run_kernel<Brightest>(width, row(-2), row(-1), row(0), row(1), row(2), down.data() + 2);
      const std::uint16_t* d = down.data();
      run_kernel<Brightest>(width, d, d + 1, d + 2, d + 3, d + 4, brightest.data());
      run_kernel<DropOutshone>(width, limits.min_neighbour_share, limits.max_gradient, row(-1), row(0),
                               row(1), static_cast<const std::uint16_t*>(brightest.data()), u.row(y));
    }
  });
}

// Mean gradient of u over blocks of block_px x block_px pixels and their neighbours, from bright pixels:
// at a brightness edge the dark side's own coordinates are too noisy to differentiate.
Image<Gradient> block_gradients(const FloatImage& u, const Image<std::uint16_t>& contrast,
                                std::uint16_t bright) {
  struct Sum {
    Gradient gradient;
    float count = 0;
  };
  Image<Sum> sums({(u.width() + block_px - 1) / block_px, (u.height() + block_px - 1) / block_px}, Sum{});
  parallel_for(0, sums.height(), 1, [&](int begin, int end) {
    for (int y = std::max(1, begin * block_px); y < std::min(end * block_px, u.height() - 1); ++y) {
      for (int x = 1; x < u.width() - 1; ++x) {
        const float across = (u(x + 1, y) - u(x - 1, y)) / 2;
        const float down = (u(x, y + 1) - u(x, y - 1)) / 2;
        const bool certain = (contrast(x, y) >= bright) & (std::abs(across) + std::abs(down) < max_slope);
        Sum& sum = sums(x / block_px, y / block_px);
        sum.gradient.across += certain ? across : 0;
        sum.gradient.down += certain ? down : 0;
        sum.count += certain;
      }
    }
  });
  Image<Gradient> gradients(sums.size());
  for (int by = 0; by < sums.height(); ++by) {
    for (int bx = 0; bx < sums.width(); ++bx) {
      Sum around;
      for (int y = std::max(0, by - 1); y <= std::min(sums.height() - 1, by + 1); ++y) {
        for (int x = std::max(0, bx - 1); x <= std::min(sums.width() - 1, bx + 1); ++x) {
          around.gradient.across += sums(x, y).gradient.across;
          around.gradient.down += sums(x, y).gradient.down;
          around.count += sums(x, y).count;
        }
      }
      const float scale = around.count > 0 ? 1 / around.count : 0;
      gradients(bx, by) = {around.gradient.across * scale, around.gradient.down * scale};
    }
  }
  return gradients;
}

// grad(u) . grad(C) / C of one row.
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

struct TakeOff {
  BODYSCAN_KERNEL void run(int width, float blur, const float* pull, float* u) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) u[x] -= blur * pull[x];
  }
};

FloatImage edge_pull(const Image<std::uint16_t>& contrast, const Image<Gradient>& gradients) {
  const Size size = contrast.size();
  FloatImage pull(size, 0);
  parallel_for(1, size.height - 1, rows_a_task, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      for (int bx = 0; bx < gradients.width(); ++bx)
        run_kernel<EdgePull>(std::max(1, bx * block_px), std::min((bx + 1) * block_px, size.width - 1),
                             gradients(bx, y / block_px), contrast.row(y - 1), contrast.row(y),
                             contrast.row(y + 1), pull.row(y));
    }
  });
  return pull;
}

// Sums of a regression through the origin of b on a.
struct Regression {
  double count = 0;
  double aa = 0;
  double ab = 0;
  double bb = 0;

  void add(float a, float b, float sigma) {
    // NaN is left out too.
    if (!(std::abs(b) < max_bend) || !(std::abs(a) < 4 * max_bend) || a == 0) return;
    const double weight = 1 / static_cast<double>(sigma * sigma + min_sigma * min_sigma);
    ++count;
    aa += weight * static_cast<double>(a * a);
    ab += weight * static_cast<double>(a * b);
    bb += weight * static_cast<double>(b * b);
  }
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

// Along the image direction in which the coordinate changes faster: across it the term is nothing but noise.
Regression regress(const AxisCorrespondence& axis, const FloatImage& pull,
                   const Image<std::uint16_t>& contrast, const Image<Gradient>& gradients,
                   std::uint16_t bright) {
  const FloatImage& u = axis.coordinate;
  std::vector<Regression> tasks(static_cast<std::size_t>(u.height() / rows_a_task + 1));
  parallel_for(2, u.height() - 2, rows_a_task, [&](int first, int last) {
    Regression here;
    for (int y = first; y < last; ++y) {
      for (int x = 2; x < u.width() - 2; ++x) {
        if (contrast(x, y) < bright) continue;
        const Gradient& gradient = gradients(x / block_px, y / block_px);
        const bool across = std::abs(gradient.across) > std::abs(gradient.down);
        const int dx = across ? 1 : 0;
        const int dy = across ? 0 : 1;
        here.add(pull(x - dx, y - dy) - 2 * pull(x, y) + pull(x + dx, y + dy),
                 u(x - dx, y - dy) - 2 * u(x, y) + u(x + dx, y + dy), axis.sigma(x, y));
      }
    }
    tasks[static_cast<std::size_t>(first / rows_a_task)] = here;
  });
  Regression all;  // summed in order, so that the result does not depend on the threads
  for (const Regression& task : tasks) all.add(task);
  return all;
}

}  // namespace

Expected<void> BrightnessEdgeLimits::check() const {
  const auto refuse = [](const char* what) { return tl::unexpected(Error{ErrorKind::usage, what}); };
  if (!(min_neighbour_share >= 0 && min_neighbour_share < 1))
    return refuse("min_neighbour_share must lie in 0 to 1");
  if (!(max_gradient > 0)) return refuse("max_gradient must be positive");
  return {};
}

float correct_camera_blur(AxisCorrespondence& axis, const Image<std::uint16_t>& contrast,
                          const BrightnessEdgeLimits& limits) {
  FloatImage& u = axis.coordinate;
  if (std::min(u.width(), u.height()) < 5) return 0;
  drop_outshone(u, contrast, limits);
  const std::uint16_t bright = bright_level(contrast);
  const Image<Gradient> gradients = block_gradients(u, contrast, bright);
  const FloatImage pull = edge_pull(contrast, gradients);
  const Regression fit = regress(axis, pull, contrast, gradients, bright);
  const bool told = fit.slope() > 0 && fit.slope() >= min_significance * fit.standard_error();
  if (!told || fit.slope() > max_blur) return 0;
  const float blur = static_cast<float>(fit.slope());
  parallel_for(0, u.height(), rows_a_task, [&](int first, int last) {
    for (int y = first; y < last; ++y) run_kernel<TakeOff>(u.width(), blur, pull.row(y), u.row(y));
  });
  return blur;
}

}  // namespace bodyscan
