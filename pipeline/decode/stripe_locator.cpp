#include "pipeline/decode/stripe_locator.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <utility>

namespace bodyscan {
namespace {

constexpr int levels = StripePlanes::fine_bits;  // 0, 1 or 2 bits dropped

struct Place {
  BODYSCAN_KERNEL void run(int begin, int end, int width, int dropped, const float* ratio,
                           const std::uint16_t* cell, const float* deviation, const float* coefficients,
                           float* coordinate, float* sigma) {
    const std::ptrdiff_t stride = width;
    const std::ptrdiff_t other = stride * EdgeProfile::terms;
    const float scale = static_cast<float>(1 << dropped);
    BODYSCAN_VECTORIZE
    for (int x = begin; x < end; ++x) {
      const float r = ratio[x];
      const float t = 2 * r - 1;
      const float hump = r * (1 - r);
      const float* first = coefficients + x;
      const float* second = first + other;
      const bool kind = EdgeProfile::kind_of(cell[x]) != 0;
      const float c0 = kind ? second[0] : first[0];
      const float c1 = kind ? second[stride] : first[stride];
      const float c2 = kind ? second[2 * stride] : first[2 * stride];
      const float c3 = kind ? second[3 * stride] : first[3 * stride];
      const float bend = c0 + t * (c1 + t * (c2 + t * c3));
      const float bend_slope = 2 * (c1 + t * (2 * c2 + t * 3 * c3));
      const float from_fine = r + hump * bend;
      const float slope = 1 - t * bend + hump * bend_slope;
      // The finest bit changes at the lower edge of odd stripes and at the upper edge of even ones.
      const float fraction = (cell[x] & 1) != 0 ? from_fine : 1 - from_fine;
      coordinate[x] = (static_cast<float>(cell[x]) + fraction) * scale - 0.5F;
      sigma[x] = (slope > 0.1F ? slope : 0.1F) * deviation[x] * scale;
    }
  }
};

}  // namespace

// One camera row's measurements.
struct StripeLocator::RowBuffer {
  explicit RowBuffer(int width)
      : ratio(static_cast<std::size_t>(width)),
        deviation(ratio.size()),
        cell(ratio.size()),
        coefficients(ratio.size() * EdgeProfile::kinds * EdgeProfile::terms) {}
  std::vector<float> ratio;
  std::vector<float> deviation;
  std::vector<std::uint16_t> cell;
  std::vector<float> coefficients;
};

// Measures row y and calls visit(dropped, begin, end) for every run of its blocks where `dropped` bits are
// dropped, while the buffer holds that level's measurements.
template <class Visit>
void StripeLocator::measure_row(int y, RowBuffer& buffer, Visit visit) const {
  const int width = contrast_.width();
  const std::uint8_t* blocks = resolution_.dropped.row(y / StripeResolution::block_px);
  const int count = resolution_.dropped.width();
  for (int dropped = 0; dropped < levels; ++dropped) {
    if (std::find(blocks, blocks + count, dropped) == blocks + count) continue;
    measure_edge_ratio(planes_, contrast_, y, dropped, limits_, buffer.ratio.data(), buffer.cell.data(),
                       buffer.deviation.data());
    for (int begin = 0; begin < count;) {
      int end = begin;
      while (end < count && blocks[end] == dropped) ++end;
      if (end > begin)
        visit(dropped, begin * StripeResolution::block_px, std::min(end * StripeResolution::block_px, width));
      begin = end + 1;
    }
  }
}

bool StripeLocator::level_occurs(int dropped) const {
  const auto blocks = resolution_.dropped.pixels();
  return std::find(blocks.begin(), blocks.end(), dropped) != blocks.end();
}

StripeLocator::StripeLocator(const StripePlanes& planes, const Image<std::uint16_t>& contrast,
                             const NoiseModel& noise, StripeResolution resolution, int count,
                             const DecodeOptions& options)
    : planes_(planes),
      contrast_(contrast),
      limits_{options.min_direct_share, options.min_signal_to_noise, noise, count},
      resolution_(std::move(resolution)) {
  const Size camera = contrast.size();
  std::vector<std::optional<EdgeProfile::Histogram>> histograms(levels);
  for (int dropped = 0; dropped < levels; ++dropped)
    if (level_occurs(dropped)) histograms[static_cast<std::size_t>(dropped)].emplace(camera);
  parallel_for(0, camera.height, EdgeProfile::tile_px, [&](int first, int last) {
    RowBuffer buffer(camera.width);
    for (int y = first; y < last; ++y) {
      measure_row(y, buffer, [&](int dropped, int begin, int end) {
        histograms[static_cast<std::size_t>(dropped)]->add_run(y, begin, end, buffer.ratio.data(),
                                                               buffer.cell.data());
      });
    }
  });
  for (int dropped = 0; dropped < levels; ++dropped) {
    const auto& histogram = histograms[static_cast<std::size_t>(dropped)];
    auto& profile = profiles_.emplace_back();
    if (histogram) profile.emplace(*histogram, dropped);
  }
}

void StripeLocator::locate(const RowRange& rows, const RowArrays& arrays) const {
  const int width = contrast_.width();
  RowBuffer buffer(width);
  for (int i = 0; i < rows.count; ++i) {
    const int y = rows.camera_row(i);
    int ready = -1;  // level whose coefficients the buffer holds
    measure_row(y, buffer, [&](int dropped, int begin, int end) {
      if (ready != dropped)
        profiles_[static_cast<std::size_t>(dropped)]->coefficients_of_row(y, width,
                                                                          buffer.coefficients.data());
      ready = dropped;
      run_kernel<Place>(begin, end, width, dropped, buffer.ratio.data(), buffer.cell.data(),
                        buffer.deviation.data(), buffer.coefficients.data(), arrays.coordinate_row(i),
                        arrays.sigma_row(i));
    });
  }
}

}  // namespace bodyscan
