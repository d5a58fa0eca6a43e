#include "pipeline/decode/stripe_amplitude.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <vector>

namespace bodyscan {
namespace {

struct AddSquares {
  BODYSCAN_KERNEL void run(int width, const std::int16_t* cosine, const std::int16_t* sine,
                           const std::uint16_t* contrast, float* squares, float* contrast_squares,
                           float* contrasts, float* pixels) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const float light = static_cast<float>(contrast[x]);
      const float lit = light > 0 ? 1.0F : 0.0F;
      const float c = lit * static_cast<float>(cosine[x]);
      const float s = lit * static_cast<float>(sine[x]);
      squares[x] += c * c + s * s;
      contrast_squares[x] += light * light;
      contrasts[x] += light;
      pixels[x] += lit;
    }
  }
};

}  // namespace

StripeAmplitude::StripeAmplitude(const PhasePlanes& planes, const Image<std::uint16_t>& contrast)
    : blocks_({(contrast.width() + block_px - 1) / block_px, (contrast.height() + block_px - 1) / block_px}),
      steps_(planes.code().steps) {
  const int width = contrast.width();
  Image<Block> sums(blocks_.size(), Block{});
  parallel_for(0, sums.height(), 1, [&](int first, int last) {
    for (int by = first; by < last; ++by) {
      FloatImage columns({width, 4}, 0);
      for (int y = by * block_px; y < std::min((by + 1) * block_px, contrast.height()); ++y)
        run_kernel<AddSquares>(width, planes.cosine().row(y), planes.sine().row(y), contrast.row(y),
                               columns.row(0), columns.row(1), columns.row(2), columns.row(3));
      for (int x = 0; x < width; ++x) {
        Block& sum = sums(x / block_px, by);
        sum.squares += columns(x, 0);
        sum.contrast_squares += columns(x, 1);
        sum.contrast += columns(x, 2);
        sum.pixels += columns(x, 3);
      }
    }
  });
  for (int by = 0; by < blocks_.height(); ++by) {
    for (int bx = 0; bx < blocks_.width(); ++bx) {
      Block& around = blocks_(bx, by) = {};
      for (int y = std::max(0, by - 1); y <= std::min(blocks_.height() - 1, by + 1); ++y) {
        for (int x = std::max(0, bx - 1); x <= std::min(blocks_.width() - 1, bx + 1); ++x) {
          around.squares += sums(x, y).squares;
          around.contrast_squares += sums(x, y).contrast_squares;
          around.contrast += sums(x, y).contrast;
          around.pixels += sums(x, y).pixels;
        }
      }
    }
  }
}

void StripeAmplitude::squares_of_row(int y, const NoiseModel& noise, int width, float* squares) const {
  for (int bx = 0; bx < blocks_.width(); ++bx) {
    const Block& block = blocks_(bx, y / block_px);
    // An amplitude's square is larger by twice the variance 2 / N of cosine and sine.
    const float of_noise =
        4 / static_cast<float>(steps_) * (noise.constant * block.pixels + noise.slope * block.contrast);
    const float share = std::max(0.0F, block.squares - of_noise) / std::max(1.0F, block.contrast_squares);
    std::fill(squares + bx * block_px, squares + std::min((bx + 1) * block_px, width), share);
  }
}

}  // namespace bodyscan
