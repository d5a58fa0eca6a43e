#include "pipeline/decode/stripe_resolution.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace bodyscan {
namespace {

constexpr int block_px = StripeResolution::block_px;
constexpr float keep_ratio = 0.25F;

struct AddSquares {
  BODYSCAN_KERNEL void run(int width, const std::int16_t* difference, const std::uint16_t* contrast,
                           float* sum) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const float value = contrast[x] > 0 ? static_cast<float>(difference[x]) : 0;
      sum[x] += value * value;
    }
  }
};

struct AddContrast {
  BODYSCAN_KERNEL void run(int width, NoiseModel noise, const std::uint16_t* contrast, float* squares,
                           float* variance) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const float value = static_cast<float>(contrast[x]);
      squares[x] += value * value;
      variance[x] += value > 0 ? noise.constant + noise.slope * value : 0;
    }
  }
};

// Calls visit(by, first, last) for every row of blocks by and its camera rows.
template <class Visit>
void for_each_block_row(Size camera, const Visit& visit) {
  parallel_for(0, (camera.height + block_px - 1) / block_px, 1, [&](int first, int last) {
    for (int by = first; by < last; ++by)
      visit(by, by * block_px, std::min((by + 1) * block_px, camera.height));
  });
}

float sum_of_block(const std::vector<float>& columns, int bx) {
  const auto begin = columns.begin() + static_cast<std::ptrdiff_t>(bx) * block_px;
  return std::accumulate(begin, begin + std::min<std::ptrdiff_t>(block_px, columns.end() - begin), 0.0F);
}

Size blocks_of(Size camera) {
  return {(camera.width + block_px - 1) / block_px, (camera.height + block_px - 1) / block_px};
}

}  // namespace

StripeResolution uniform_resolution(Size camera, int dropped) {
  return {Image<std::uint8_t>(blocks_of(camera), static_cast<std::uint8_t>(dropped))};
}

StripeEnergy::StripeEnergy(const Image<std::uint16_t>& contrast, const NoiseModel& noise)
    : blocks_(blocks_of(contrast.size()), Block{}) {
  for_each_block_row(contrast.size(), [&](int by, int first, int last) {
    std::vector<float> squares(static_cast<std::size_t>(contrast.width()), 0);
    std::vector<float> variance(squares);
    for (int y = first; y < last; ++y)
      run_kernel<AddContrast>(contrast.width(), noise, contrast.row(y), squares.data(), variance.data());
    for (int bx = 0; bx < blocks_.width(); ++bx) {
      blocks_(bx, by).squares.back() = sum_of_block(squares, bx);
      blocks_(bx, by).noise = sum_of_block(variance, bx);
    }
  });
}

void StripeEnergy::add(int bit, const Image<std::int16_t>& difference, const Image<std::uint16_t>& contrast) {
  for_each_block_row(contrast.size(), [&](int by, int first, int last) {
    std::vector<float> squares(static_cast<std::size_t>(contrast.width()), 0);
    for (int y = first; y < last; ++y)
      run_kernel<AddSquares>(contrast.width(), difference.row(y), contrast.row(y), squares.data());
    for (int bx = 0; bx < blocks_.width(); ++bx)
      blocks_(bx, by).squares[static_cast<std::size_t>(bit)] = sum_of_block(squares, bx);
  });
}

StripeEnergy::Block StripeEnergy::sum_around(int bx, int by) const {
  Block sum;
  for (int y = std::max(0, by - 1); y <= std::min(blocks_.height() - 1, by + 1); ++y) {
    for (int x = std::max(0, bx - 1); x <= std::min(blocks_.width() - 1, bx + 1); ++x) {
      const Block& block = blocks_(x, y);
      for (std::size_t i = 0; i < sum.squares.size(); ++i) sum.squares[i] += block.squares[i];
      sum.noise += block.noise;
    }
  }
  return sum;
}

StripeResolution StripeEnergy::resolve(int bit_count, int max_dropped_bits) const {
  const int droppable = std::min({max_dropped_bits, StripePlanes::fine_bits - 1, std::max(0, bit_count - 2)});
  StripeResolution resolution{Image<std::uint8_t>(blocks_.size(), 0)};
  for (int by = 0; by < blocks_.height(); ++by) {
    for (int bx = 0; bx < blocks_.width(); ++bx) {
      const Block energy = sum_around(bx, by);
      std::uint8_t& dropped = resolution.dropped(bx, by);
      for (std::size_t bit = 0; bit < static_cast<std::size_t>(droppable); ++bit)
        if (energy.squares[bit] - energy.noise <
            keep_ratio * keep_ratio * (energy.squares[bit + 2] - energy.noise))
          dropped = static_cast<std::uint8_t>(bit + 1);
    }
  }
  return resolution;
}

}  // namespace bodyscan
