#include "pipeline/board/board_pictures.hpp"

#include "pipeline/base/parallel.hpp"
#include "pipeline/decode/response.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <vector>

namespace bodyscan {
namespace {

constexpr float min_light = 0.3F;  // grey levels of linear light: a ratio to less is noise
constexpr double too_dark = 12;    // grey levels, mean
constexpr int rows_a_task = 32;

}  // namespace

FloatImage encoded(const Luma& luma) {
  FloatImage image(size_of(luma));
  std::visit(
      [&](const auto& picture) {
        using Pixel = std::decay_t<decltype(picture(0, 0))>;
        constexpr float scale = full_scale / static_cast<float>(std::numeric_limits<Pixel>::max());
        for (std::size_t i = 0; i < picture.size().area(); ++i)
          image.data()[i] = scale * static_cast<float>(picture.data()[i]);
      },
      luma);
  return image;
}

FloatImage linear(const Luma& luma) {
  FloatImage image(size_of(luma));
  std::visit(
      [&](const auto& picture) {
        using Pixel = std::decay_t<decltype(picture(0, 0))>;
        const std::vector<std::uint16_t> table = linear_table({}, 8 * sizeof(Pixel));
        const float scale = full_scale / static_cast<float>(table.back());
        for (std::size_t i = 0; i < picture.size().area(); ++i)
          image.data()[i] = scale * static_cast<float>(table[picture.data()[i]]);
      },
      luma);
  return image;
}

FloatImage reduced(const FloatImage& image, int factor) {
  if (factor == 1) return image.clone();
  FloatImage small({image.width() / factor, image.height() / factor});
  const float share = 1 / static_cast<float>(factor * factor);
  parallel_for(0, small.height(), rows_a_task, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      float* out = small.row(y);
      std::fill_n(out, small.width(), 0.0F);
      for (int j = 0; j < factor; ++j) {
        const float* row = image.row(y * factor + j);
        for (int x = 0; x < small.width(); ++x)
          for (int i = 0; i < factor; ++i) out[x] += row[x * factor + i];
      }
      for (int x = 0; x < small.width(); ++x) out[x] *= share;
    }
  });
  return small;
}

FloatImage ratio_of(const FloatImage& later, const FloatImage& earlier) {
  FloatImage ratio(later.size());
  for (std::size_t i = 0; i < ratio.size().area(); ++i) {
    const float value = later.data()[i] / std::max(earlier.data()[i], min_light);
    ratio.data()[i] = same_light_level * std::min(value, max_ratio);
  }
  return ratio;
}

FloatImage trust_in(const FloatImage& earlier) {
  FloatImage trust(earlier.size());
  float brightest = min_light;
  for (const float value : earlier.pixels()) brightest = std::max(brightest, value);
  for (std::size_t i = 0; i < trust.size().area(); ++i)
    trust.data()[i] = std::max(earlier.data()[i], 0.0F) / brightest;
  return trust;
}

std::string light_hint(const FloatImage& image) {
  std::size_t white = 0;
  double sum = 0;
  for (const float value : image.pixels()) {
    white += value >= saturated ? 1 : 0;
    sum += static_cast<double>(value);
  }
  const double count = static_cast<double>(image.size().area());
  if (static_cast<double>(white) > overexposed_share * count) return " (over-exposed)";
  if (sum < too_dark * count) return " (too dark)";
  return "";
}

}  // namespace bodyscan
