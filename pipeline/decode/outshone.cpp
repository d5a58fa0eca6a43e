#include "pipeline/decode/outshone.hpp"

#include "pipeline/base/instruction_set.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace bodyscan {
namespace {

// The largest of the pixel and two neighbours on each side, `stride` apart; beyond the border counts as dark.
struct Brightest {
  BODYSCAN_KERNEL void run(int width, const std::uint16_t* two_before, const std::uint16_t* before,
                           const std::uint16_t* here, const std::uint16_t* after,
                           const std::uint16_t* two_after, std::uint16_t* brightest) {
    BODYSCAN_VECTORIZE
    for (int x = 0; x < width; ++x) {
      const std::uint16_t near = std::max(std::max(before[x], after[x]), here[x]);
      brightest[x] = std::max(std::max(two_before[x], two_after[x]), near);
    }
  }
};

struct DropOutshone {
  BODYSCAN_KERNEL void run(int width, float min_share, float max_gradient, const std::uint16_t* above,
                           const std::uint16_t* contrast, const std::uint16_t* below,
                           const std::uint16_t* brightest, float* u) {
    BODYSCAN_VECTORIZE
    for (int x = 1; x < width - 1; ++x) {
      const float own = static_cast<float>(contrast[x]);
      const float across = static_cast<float>(contrast[x + 1]) - static_cast<float>(contrast[x - 1]);
      const float down = static_cast<float>(below[x]) - static_cast<float>(above[x]);
      const float limit = 2 * max_gradient * own;
      const bool mixed = across * across + down * down > limit * limit;
      const bool outshone = own < min_share * static_cast<float>(brightest[x]);
      u[x] = mixed | outshone ? std::numeric_limits<float>::quiet_NaN() : u[x];
    }
  }
};

}  // namespace

Expected<void> BrightnessEdgeLimits::check() const {
  const auto refuse = [](const char* what) { return tl::unexpected(Error{ErrorKind::usage, what}); };
  if (!(min_neighbour_share >= 0 && min_neighbour_share < 1))
    return refuse("min_neighbour_share must lie in 0 to 1");
  if (!(max_gradient > 0)) return refuse("max_gradient must be positive");
  return {};
}

void drop_outshone(const Image<std::uint16_t>& contrast, const BrightnessEdgeLimits& limits,
                   const RowRange& rows, const RowArrays& arrays) {
  const int width = contrast.width();
  // Two dark pixels beyond both ends.
  std::vector<std::uint16_t> down(static_cast<std::size_t>(width) + 4, 0);
  std::vector<std::uint16_t> brightest(static_cast<std::size_t>(width));
  for (int i = 0; i < rows.count; ++i) {
    const auto row = [&](int offset) {
      return contrast.row(std::clamp(rows.camera_row(i) + offset, 0, contrast.height() - 1));
    };
    run_kernel<Brightest>(width, row(-2), row(-1), row(0), row(1), row(2), down.data() + 2);
    const std::uint16_t* d = down.data();
    run_kernel<Brightest>(width, d, d + 1, d + 2, d + 3, d + 4, brightest.data());
    run_kernel<DropOutshone>(width, limits.min_neighbour_share, limits.max_gradient, row(-1), row(0), row(1),
                             static_cast<const std::uint16_t*>(brightest.data()), arrays.coordinate_row(i));
  }
}

}  // namespace bodyscan
