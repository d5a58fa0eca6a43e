#include "pipeline/decode/stripe_resolution.hpp"

#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <array>

namespace bodyscan {
namespace {

constexpr float keep_ratio = 0.25F;

// Mean squares over a block's lit pixels: the differences of bits 0, 1, 2, then white minus black, which
// stands for all bits beyond.
struct Energy {
  std::array<float, StripePlanes::fine_bits + 1> squares{};
  float noise = 0;
};

void add_row(const StripePlanes& planes, const std::uint16_t* contrast, const NoiseModel& noise, int y,
             int begin, int end, Energy& energy) {
  for (std::size_t bit = 0; bit < planes.fine.size(); ++bit) {
    const std::int16_t* fine = planes.fine[bit].row(y);
    float sum = 0;
    for (int x = begin; x < end; ++x) {
      const float value = contrast[x] > 0 ? static_cast<float>(fine[x]) : 0;
      sum += value * value;
    }
    energy.squares[bit] += sum;
  }
  for (int x = begin; x < end; ++x) {
    const float value = static_cast<float>(contrast[x]);
    energy.squares.back() += value * value;
    energy.noise += value > 0 ? noise.variance(value) : 0;
  }
}

Image<Energy> measure_blocks(const StripePlanes& planes, const Image<std::uint16_t>& contrast,
                             const NoiseModel& noise) {
  constexpr int block = StripeResolution::block_px;
  const Size camera = contrast.size();
  Image<Energy> blocks({(camera.width + block - 1) / block, (camera.height + block - 1) / block}, Energy{});
  parallel_for(0, blocks.height(), 1, [&](int begin, int end) {
    for (int y = begin * block; y < std::min(end * block, camera.height); ++y) {
      for (int bx = 0; bx < blocks.width(); ++bx)
        add_row(planes, contrast.row(y), noise, y, bx * block, std::min((bx + 1) * block, camera.width),
                blocks(bx, y / block));
    }
  });
  return blocks;
}

Energy sum_around(const Image<Energy>& blocks, int bx, int by) {
  Energy sum;
  for (int y = std::max(0, by - 1); y <= std::min(blocks.height() - 1, by + 1); ++y) {
    for (int x = std::max(0, bx - 1); x <= std::min(blocks.width() - 1, bx + 1); ++x) {
      const Energy& energy = blocks(x, y);
      for (std::size_t i = 0; i < sum.squares.size(); ++i) sum.squares[i] += energy.squares[i];
      sum.noise += energy.noise;
    }
  }
  return sum;
}

}  // namespace

StripeResolution find_stripe_resolution(const StripePlanes& planes, const Image<std::uint16_t>& contrast,
                                        const NoiseModel& noise, int max_dropped_bits) {
  const Image<Energy> blocks = measure_blocks(planes, contrast, noise);
  const int droppable =
      std::min({max_dropped_bits, StripePlanes::fine_bits - 1, std::max(0, planes.bit_count - 2)});
  StripeResolution resolution{Image<std::uint8_t>(blocks.size(), 0)};
  for (int by = 0; by < blocks.height(); ++by) {
    for (int bx = 0; bx < blocks.width(); ++bx) {
      const Energy energy = sum_around(blocks, bx, by);
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
