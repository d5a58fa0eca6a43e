#include "pipeline/decode/phase_harmonic.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace bodyscan {
namespace {

constexpr int tile_px = PhaseHarmonic::tile_px;
constexpr int row_step = 3;           // every third camera row tells enough
constexpr int blur_passes = 8;        // 1 2 1 over tiles, as a window that fades out
constexpr double prior_pixels = 300;  // of the whole picture's mean, that every tile's own are mixed with
constexpr double max_mean = 0.4;      // beyond, something else than harmonics

struct Normalize {
  BODYSCAN_KERNEL void run(int width, const std::int16_t* cosine, const std::int16_t* sine,
                           float* unit_cosine, float* unit_sine) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const float c = static_cast<float>(cosine[x]);
      const float s = static_cast<float>(sine[x]);
      const float squared = c * c + s * s;
      const float scale = 1 / std::sqrt(squared > 1 ? squared : 1);
      unit_cosine[x] = c * scale;
      unit_sine[x] = s * scale;
    }
  }
};

struct Multiply {
  BODYSCAN_KERNEL void run(int width, const float* unit_cosine, const float* unit_sine, float* cosine,
                           float* sine) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const float c = cosine[x] * unit_cosine[x] - sine[x] * unit_sine[x];
      sine[x] = cosine[x] * unit_sine[x] + sine[x] * unit_cosine[x];
      cosine[x] = c;
    }
  }
};

struct AddWeighted {
  BODYSCAN_KERNEL void run(int width, const std::uint16_t* contrast, const float* cosine, float* weights,
                           float* sums) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const float weight = static_cast<float>(contrast[x]) * static_cast<float>(contrast[x]);
      weights[x] += weight;
      sums[x] += weight * cosine[x];
    }
  }
};

struct Sum {
  double weight = 0;
  double cosine = 0;

  Sum operator+(const Sum& other) const { return {weight + other.weight, cosine + other.cosine}; }
  Sum operator*(double share) const { return {share * weight, share * cosine}; }
};

// 1 2 1 over four, along `count` sums that lie `stride` apart; what lies beyond the border counts as empty.
void blur_line(Sum* first, std::ptrdiff_t stride, int count) {
  Sum before;
  for (int i = 0; i < count; ++i) {
    const Sum here = first[i * stride];
    const Sum after = i + 1 < count ? first[(i + 1) * stride] : Sum{};
    first[i * stride] = here * 0.5 + (before + after) * 0.25;
    before = here;
  }
}

void blur(Image<Sum>& tiles) {
  for (int pass = 0; pass < blur_passes; ++pass) {
    for (int y = 0; y < tiles.height(); ++y) blur_line(tiles.row(y), 1, tiles.width());
    for (int x = 0; x < tiles.width(); ++x) blur_line(tiles.data() + x, tiles.width(), tiles.height());
  }
}

Image<Sum> sum_tiles(const PhasePlanes& planes, const Image<std::uint16_t>& contrast) {
  const int width = contrast.width();
  Image<Sum> sums({(width + tile_px - 1) / tile_px, (contrast.height() + tile_px - 1) / tile_px}, Sum{});
  parallel_for(0, sums.height(), 1, [&](int first, int last) {
    PhasePower power(width);
    for (int ty = first; ty < last; ++ty) {
      FloatImage columns({width, 2}, 0);
      for (int y = ty * tile_px; y < std::min((ty + 1) * tile_px, contrast.height()); y += row_step) {
        power.measure(planes, y);
        run_kernel<AddWeighted>(width, contrast.row(y), static_cast<const float*>(power.cosine.data()),
                                columns.row(0), columns.row(1));
      }
      for (int x = 0; x < width; ++x) {
        Sum& sum = sums(x / tile_px, ty);
        sum = sum + Sum{columns(x, 0), columns(x, 1)};
      }
    }
  });
  return sums;
}

}  // namespace

void PhasePower::measure(const PhasePlanes& planes, int y) {
  const int width = static_cast<int>(cosine.size());
  unit_cosine_.resize(cosine.size());
  unit_sine_.resize(cosine.size());
  run_kernel<Normalize>(width, planes.cosine().row(y), planes.sine().row(y), unit_cosine_.data(),
                        unit_sine_.data());
  cosine = unit_cosine_;
  sine = unit_sine_;
  for (int power = 1; power < planes.code().steps; ++power)
    run_kernel<Multiply>(width, static_cast<const float*>(unit_cosine_.data()),
                         static_cast<const float*>(unit_sine_.data()), cosine.data(), sine.data());
}

PhaseHarmonic::PhaseHarmonic(const PhasePlanes& planes, const Image<std::uint16_t>& contrast) {
  Image<Sum> sums = sum_tiles(planes, contrast);
  tiles_ = FloatImage(sums.size());
  Sum whole;
  for (const Sum& sum : sums.pixels()) whole = whole + sum;
  const double pixels = static_cast<double>(contrast.size().area()) / row_step;
  const Sum prior = whole * (prior_pixels / pixels);
  blur(sums);
  for (std::size_t i = 0; i < sums.size().area(); ++i) {
    const Sum sum = sums.data()[i] + prior;
    const double mean = sum.weight > 0 ? std::clamp(sum.cosine / sum.weight, -max_mean, max_mean) : 0;
    // The mean of cos(t + c sin t) is the Bessel function -J1(c), about -c / 2 (1 - c^2 / 8).
    tiles_.data()[i] = static_cast<float>(-2 * mean * (1 + mean * mean / 2) / planes.code().steps);
  }
}

void PhaseHarmonic::of_row(int y, std::vector<float>& harmonic) const {
  const auto position = [](int pixel, int tiles) {
    return std::clamp((static_cast<float>(pixel) + 0.5F) / tile_px - 0.5F, 0.0F,
                      static_cast<float>(tiles - 1));
  };
  const float v = position(y, tiles_.height());
  const int top = static_cast<int>(v);
  const float* above = tiles_.row(top);
  const float* below = tiles_.row(std::min(top + 1, tiles_.height() - 1));
  const float down = v - static_cast<float>(top);
  const auto of_tile = [&](int tx) { return above[tx] + down * (below[tx] - above[tx]); };
  const int width = static_cast<int>(harmonic.size());
  for (int tx = -1; tx < tiles_.width(); ++tx) {
    // From this tile's centre to the next one's.
    const float a = of_tile(std::max(tx, 0));
    const float slope = (of_tile(std::min(tx + 1, tiles_.width() - 1)) - a) / tile_px;
    const int centre = tx * tile_px + tile_px / 2;
    for (int x = std::max(0, centre); x < std::min(centre + tile_px, width); ++x)
      harmonic[static_cast<std::size_t>(x)] = a + slope * (static_cast<float>(x - centre) + 0.5F);
  }
}

}  // namespace bodyscan
