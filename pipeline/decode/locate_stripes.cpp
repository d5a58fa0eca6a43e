#include "pipeline/decode/locate_stripes.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/decode/edge_profile.hpp"
#include "pipeline/decode/edge_ratio.hpp"
#include "pipeline/decode/noise.hpp"
#include "pipeline/decode/stripe_resolution.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

namespace bodyscan {
namespace {

constexpr int levels = StripePlanes::fine_bits;  // 0, 1 or 2 bits dropped

// One camera row's measurements.
struct RowBuffer {
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

// Calls visit(begin, end) for the runs of row y's blocks where `dropped` bits are dropped.
template <class Visit>
void for_each_run(const StripeResolution& resolution, int y, int dropped, int width, Visit visit) {
  const std::uint8_t* blocks = resolution.dropped.row(y / StripeResolution::block_px);
  const int count = resolution.dropped.width();
  for (int begin = 0; begin < count;) {
    int end = begin;
    while (end < count && blocks[end] == dropped) ++end;
    if (end > begin)
      visit(begin * StripeResolution::block_px, std::min(end * StripeResolution::block_px, width));
    begin = end + 1;
  }
}

bool row_has_level(const StripeResolution& resolution, int y, int dropped) {
  const std::uint8_t* blocks = resolution.dropped.row(y / StripeResolution::block_px);
  return std::find(blocks, blocks + resolution.dropped.width(), dropped) !=
         blocks + resolution.dropped.width();
}

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

AxisCorrespondence locate_stripes(const StripePlanes& planes, const Illumination& light, int count,
                                  const DecodeOptions& options) {
  const Size camera = light.contrast.size();
  const NoiseModel noise = measure_noise(planes, light.contrast);
  const StripeResolution resolution =
      find_stripe_resolution(planes, light.contrast, noise, options.max_dropped_bits);
  const EdgeRatioLimits limits{options.min_direct_share, options.min_signal_to_noise, noise, count};

  // Calls visit(y, dropped, measured row) for every camera row and number of dropped bits that occurs in it.
  const auto for_each_measured_row = [&](const auto& visit) {
    parallel_for(0, camera.height, EdgeProfile::tile_px, [&](int first, int last) {
      RowBuffer buffer(camera.width);
      for (int y = first; y < last; ++y) {
        for (int dropped = 0; dropped < levels; ++dropped) {
          if (!row_has_level(resolution, y, dropped)) continue;
          measure_edge_ratio(planes, light.contrast, y, dropped, limits, buffer.ratio.data(),
                             buffer.cell.data(), buffer.deviation.data());
          visit(y, dropped, buffer);
        }
      }
    });
  };

  std::vector<EdgeProfile::Histogram> histograms;
  for (int dropped = 0; dropped < levels; ++dropped) histograms.emplace_back(camera);
  for_each_measured_row([&](int y, int dropped, const RowBuffer& buffer) {
    for_each_run(resolution, y, dropped, camera.width, [&](int begin, int end) {
      histograms[static_cast<std::size_t>(dropped)].add_run(y, begin, end, buffer.ratio.data(),
                                                            buffer.cell.data());
    });
  });
  std::vector<EdgeProfile> profiles;
  for (int dropped = 0; dropped < levels; ++dropped)
    profiles.emplace_back(histograms[static_cast<std::size_t>(dropped)], dropped);

  AxisCorrespondence result{FloatImage(camera), FloatImage(camera)};
  for_each_measured_row([&](int y, int dropped, RowBuffer& buffer) {
    profiles[static_cast<std::size_t>(dropped)].coefficients_of_row(y, camera.width,
                                                                    buffer.coefficients.data());
    for_each_run(resolution, y, dropped, camera.width, [&](int begin, int end) {
      run_kernel<Place>(begin, end, camera.width, dropped, buffer.ratio.data(), buffer.cell.data(),
                        buffer.deviation.data(), buffer.coefficients.data(), result.coordinate.row(y),
                        result.sigma.row(y));
    });
  });
  return result;
}

}  // namespace bodyscan
