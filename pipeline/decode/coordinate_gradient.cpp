#include "pipeline/decode/coordinate_gradient.hpp"

#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace bodyscan {
namespace {

constexpr float bright_share = 0.25F;  // of the 95th percentile of contrast: a pixel below has no say
constexpr std::size_t bright_samples = 65536;
constexpr float max_slope = 4;  // projector px a camera px
constexpr int rows_a_task = 32;

std::uint16_t bright_level(const Image<std::uint16_t>& contrast) {
  std::vector<std::uint16_t> lit;
  const std::size_t step = 1 + contrast.size().area() / bright_samples;
  for (std::size_t i = 0; i < contrast.size().area(); i += step)
    if (contrast.data()[i] > 0) lit.push_back(contrast.data()[i]);
  if (lit.empty()) return std::numeric_limits<std::uint16_t>::max();
  const auto high = lit.begin() + static_cast<std::ptrdiff_t>(lit.size() * 95 / 100);
  std::nth_element(lit.begin(), high, lit.end());
  return static_cast<std::uint16_t>(bright_share * static_cast<float>(*high));
}

struct Sum {
  Gradient gradient;
  float count = 0;
};

void add_row(const FloatImage& u, int k, const std::uint16_t* contrast, std::uint16_t bright, Sum* blocks) {
  constexpr int step = SampledRows::step;
  const float* above = u.row(k - 1);
  const float* here = u.row(k);
  const float* below = u.row(k + 1);
  for (int begin = 0; begin < u.width(); begin += GradientMap::block_px, ++blocks) {
    const int end = std::min(begin + GradientMap::block_px, u.width() - 1);
    for (int x = std::max(1, begin); x < end; ++x) {
      const float across = (here[x + 1] - here[x - 1]) / 2;
      const float down = (below[x] - above[x]) / (2 * step);
      const bool certain = (contrast[x] >= bright) & (std::abs(across) + std::abs(down) < max_slope);
      blocks->gradient.across += certain ? across : 0;
      blocks->gradient.down += certain ? down : 0;
      blocks->count += certain;
    }
  }
}

Gradient mean_around(const Image<Sum>& sums, int bx, int by) {
  Sum around;
  for (int y = std::max(0, by - 1); y <= std::min(sums.height() - 1, by + 1); ++y) {
    for (int x = std::max(0, bx - 1); x <= std::min(sums.width() - 1, bx + 1); ++x) {
      around.gradient.across += sums(x, y).gradient.across;
      around.gradient.down += sums(x, y).gradient.down;
      around.count += sums(x, y).count;
    }
  }
  const float scale = around.count > 0 ? 1 / around.count : 0;
  return {around.gradient.across * scale, around.gradient.down * scale};
}

}  // namespace

SampledRows::SampledRows(Size camera) {
  const Size size{camera.width, (camera.height + step - 1) / step};
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  values = {FloatImage(size, none), FloatImage(size, none)};
}

void SampledRows::measure(const CoordinateRows& rows) {
  parallel_for(0, values.coordinate.height(), rows_a_task, [&](int first, int last) {
    rows({first * step, last - first, step},
         {values.coordinate.row(first), values.sigma.row(first), values.coordinate.width()});
  });
}

GradientMap::GradientMap(const SampledRows& sampled, const Image<std::uint16_t>& contrast)
    : bright_(bright_level(contrast)),
      blocks_({(contrast.width() + block_px - 1) / block_px, (contrast.height() + block_px - 1) / block_px}) {
  const FloatImage& u = sampled.values.coordinate;
  Image<Sum> sums(blocks_.size(), Sum{});
  parallel_for(0, blocks_.height(), 1, [&](int first, int last) {
    const auto sampled_from = [](int by) {
      return (by * block_px + SampledRows::step - 1) / SampledRows::step;
    };
    for (int by = first; by < last; ++by) {
      const int end = std::min(sampled_from(by + 1), u.height() - 1);
      for (int k = std::max(1, sampled_from(by)); k < end; ++k)
        add_row(u, k, contrast.row(k * SampledRows::step), bright_, sums.row(by));
    }
  });
  for (int by = 0; by < blocks_.height(); ++by)
    for (int bx = 0; bx < blocks_.width(); ++bx) blocks_(bx, by) = mean_around(sums, bx, by);
}

float GradientMap::px_per_unit() const {
  std::vector<float> slopes;
  for (const Gradient& gradient : blocks_.pixels()) {
    const float slope = std::max(std::abs(gradient.across), std::abs(gradient.down));
    if (slope > 0) slopes.push_back(slope);
  }
  if (slopes.empty()) return 0;
  const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
  std::nth_element(slopes.begin(), middle, slopes.end());
  return 1 / std::max(*middle, 1e-3F);
}

}  // namespace bodyscan
