#include "tools/simulator/lens_blur.hpp"

#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace bodyscan::simulator {
namespace {

constexpr int rows_at_once = 8;
constexpr int channels = 3;

// Of the middle pixel, then of those 1, 2, ... beside it on either side; the sum over both sides is 1.
std::vector<float> gaussian_weights(double sigma_px) {
  std::vector<double> weights;
  double sum = -1;
  for (int i = 0; i <= lens_blur_reach(sigma_px); ++i) {
    weights.push_back(std::exp(-0.5 * i * i / (sigma_px * sigma_px)));
    sum += 2 * weights.back();
  }
  std::vector<float> normalised;
  for (const double weight : weights) normalised.push_back(static_cast<float>(weight / sum));
  return normalised;
}

// A row with `reach` copies of its outermost pixels on either side.
void pad(const float* row, int width, int reach, std::vector<float>& padded) {
  padded.resize(static_cast<std::size_t>((width + 2 * reach) * channels));
  std::copy_n(row, width * channels, padded.begin() + reach * channels);
  for (int i = 0; i < reach * channels; ++i) {
    padded[static_cast<std::size_t>(i)] = row[i % channels];
    padded[static_cast<std::size_t>((reach + width) * channels + i)] =
        row[(width - 1) * channels + i % channels];
  }
}

void blur_rows(LightImage& image, const std::vector<float>& weights) {
  const int reach = static_cast<int>(weights.size()) - 1;
  const int width = image.width();
  parallel_for(0, image.height(), rows_at_once, [&](int begin, int end) {
    std::vector<float> padded;
    for (int y = begin; y < end; ++y) {
      float* row = image.row(y)->data();
      pad(row, width, reach, padded);
      const float* middle = padded.data() + static_cast<std::ptrdiff_t>(reach) * channels;
      for (int i = 0; i < width * channels; ++i) row[i] = weights[0] * middle[i];
      for (int k = 1; k <= reach; ++k) {
        const float weight = weights[static_cast<std::size_t>(k)];
        const float* before = middle - static_cast<std::ptrdiff_t>(k) * channels;
        const float* behind = middle + static_cast<std::ptrdiff_t>(k) * channels;
        for (int i = 0; i < width * channels; ++i) row[i] += weight * (before[i] + behind[i]);
      }
    }
  });
}

void blur_columns(const LightImage& image, const std::vector<float>& weights, LightImage& result) {
  const int reach = static_cast<int>(weights.size()) - 1;
  const int last = image.height() - 1;
  parallel_for(0, image.height(), rows_at_once, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      float* row = result.row(y)->data();
      const float* middle = image.row(y)->data();
      for (int i = 0; i < image.width() * channels; ++i) row[i] = weights[0] * middle[i];
      for (int k = 1; k <= reach; ++k) {
        const float weight = weights[static_cast<std::size_t>(k)];
        const float* above = image.row(std::max(0, y - k))->data();
        const float* below = image.row(std::min(last, y + k))->data();
        for (int i = 0; i < image.width() * channels; ++i) row[i] += weight * (above[i] + below[i]);
      }
    }
  });
}

}  // namespace

int lens_blur_reach(double sigma_px) {
  return static_cast<int>(std::ceil(4 * sigma_px));
}

void blur_light(LightImage& image, double sigma_px) {
  const std::vector<float> weights = gaussian_weights(sigma_px);
  blur_rows(image, weights);
  LightImage result(image.size());
  blur_columns(image, weights, result);
  image = std::move(result);
}

}  // namespace bodyscan::simulator
