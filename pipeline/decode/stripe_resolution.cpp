#include "pipeline/decode/stripe_resolution.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "pipeline/base/parallel.hpp"

namespace bodyscan {
namespace {

const float keep_ratio = getenv("KR") ? (float)atof(getenv("KR")) : 0.5F;

using Sums = std::array<float, StripePlanes::fine_bits>;  // of |difference| of bits 0, 1, 2

Image<Sums> sum_blocks(const StripePlanes& planes, const Image<std::uint16_t>& contrast) {
  constexpr int block = StripeResolution::block_px;
  const Size camera = contrast.size();
  Image<Sums> sums({(camera.width + block - 1) / block, (camera.height + block - 1) / block}, Sums{});
  parallel_for(0, sums.height(), 1, [&](int begin, int end) {
    for (int y = begin * block; y < std::min(end * block, camera.height); ++y) {
      Sums* row = sums.row(y / block);
      for (std::size_t bit = 0; bit < planes.fine.size(); ++bit) {
        const std::int16_t* fine = planes.fine[bit].row(y);
        const std::uint16_t* lit = contrast.row(y);
        for (int bx = 0; bx < sums.width(); ++bx) {
          int sum = 0;
          for (int x = bx * block; x < std::min((bx + 1) * block, camera.width); ++x)
            sum += lit[x] > 0 ? std::abs(static_cast<int>(fine[x])) : 0;
          row[bx][bit] += static_cast<float>(sum);
        }
      }
    }
  });
  return sums;
}

}  // namespace

StripeResolution find_stripe_resolution(const StripePlanes& planes, const Image<std::uint16_t>& contrast,
                                        int max_dropped_bits) {
  const Image<Sums> sums = sum_blocks(planes, contrast);
  const int droppable = std::min({max_dropped_bits, StripePlanes::fine_bits - 1, planes.bit_count - 2});
  StripeResolution resolution{Image<std::uint8_t>(sums.size(), 0)};
  for (int by = 0; by < sums.height(); ++by) {
    for (int bx = 0; bx < sums.width(); ++bx) {
      Sums around{};
      for (int y = std::max(0, by - 1); y <= std::min(sums.height() - 1, by + 1); ++y)
        for (int x = std::max(0, bx - 1); x <= std::min(sums.width() - 1, bx + 1); ++x)
          for (std::size_t bit = 0; bit < around.size(); ++bit) around[bit] += sums(x, y)[bit];
      int dropped = 0;
      for (int bit = 0; bit < droppable; ++bit) {
        const auto b = static_cast<std::size_t>(bit);
        if (around[b] < keep_ratio * around[b + 1]) dropped = bit + 1;
      }
      resolution.dropped(bx, by) = static_cast<std::uint8_t>(dropped);
    }
  }
  return resolution;
}

}  // namespace bodyscan
