#include "pipeline/decode/edge_ratio.hpp"

#include "pipeline/base/instruction_set.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace bodyscan {
namespace {

struct Inputs {
  int width;
  int dropped;
  int count;
  float min_direct_share;
  float min_signal_to_noise;
  NoiseModel noise;
  const std::uint16_t* gray;
  const std::int16_t* fine;
  const std::uint16_t* coarse;
  const std::uint16_t* contrast;
};

struct CoarserOf {
  BODYSCAN_KERNEL void run(int width, const std::int16_t* difference, std::uint16_t* smallest) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const auto size = static_cast<std::uint16_t>(difference[x] < 0 ? -difference[x] : difference[x]);
      smallest[x] = size < smallest[x] ? size : smallest[x];
    }
  }
};

struct EdgeRatio {
  BODYSCAN_KERNEL void run(Inputs in, float* ratio, std::uint16_t* cell, float* deviation) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < in.width; ++x) {
      unsigned binary = in.gray[x];
      binary ^= binary >> 8;
      binary ^= binary >> 4;
      binary ^= binary >> 2;
      binary ^= binary >> 1;
      const unsigned index = binary >> in.dropped;
      cell[x] = static_cast<std::uint16_t>(index);

      const float contrast = static_cast<float>(in.contrast[x]);
      const float fine = std::abs(static_cast<float>(in.fine[x]));
      const float coarse = static_cast<float>(in.coarse[x]);
      const float total = fine + coarse;
      const float variance = in.noise.constant + in.noise.slope * contrast;
      // The picture's first and last stripe lack one of their edges.
      const bool inside = (index > 0) & (((index + 1) << in.dropped) < static_cast<unsigned>(in.count));
      const bool direct = (contrast > 0) & (total >= in.min_direct_share * contrast) &
                          (total * total >= in.min_signal_to_noise * in.min_signal_to_noise * variance);
      const float scale = 1 / (total > 1 ? total : 1);
      ratio[x] = inside & direct ? fine * scale : std::numeric_limits<float>::quiet_NaN();
      deviation[x] = std::sqrt(variance * (fine * fine + coarse * coarse)) * scale * scale;
    }
  }
};

}  // namespace

void measure_edge_ratio(const StripePlanes& planes, const Image<std::uint16_t>& contrast, int y, int dropped,
                        const EdgeRatioLimits& limits, float* ratio, std::uint16_t* cell, float* deviation) {
  const int width = contrast.width();
  std::vector<std::uint16_t> coarse(planes.coarse.row(y), planes.coarse.row(y) + width);
  for (int bit = dropped + 1; bit < StripePlanes::fine_bits && bit < planes.bit_count; ++bit)
    run_kernel<CoarserOf>(width, planes.fine[static_cast<std::size_t>(bit)].row(y), coarse.data());
  run_kernel<EdgeRatio>(
      Inputs{width, dropped, limits.count, limits.min_direct_share, limits.min_signal_to_noise, limits.noise,
             planes.gray.row(y), planes.fine[static_cast<std::size_t>(dropped)].row(y), coarse.data(),
             contrast.row(y)},
      ratio, cell, deviation);
}

}  // namespace bodyscan
