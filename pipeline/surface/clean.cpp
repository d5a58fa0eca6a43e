#include "pipeline/surface/clean.hpp"

#include "pipeline/base/parallel.hpp"
#include "pipeline/surface/range_rows.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <vector>

namespace bodyscan {
namespace {

constexpr int reach = RangeRow::padding;
constexpr int block = 512;  // pixels whose working set stays in the first-level cache
constexpr float infinity = std::numeric_limits<float>::infinity();

// The options, for squared ranges: multiplied by z^2 they are limits on differences of s.
struct Limits {
  float support;
  float flying_squared;
  float spike;
  float spike_sigma;  // times z
  float footprint;    // times z: mm
  int min_support;
  float rim;  // as spike
  float rim_sigma;
};

struct RowWindow {
  std::array<const float*, 2 * reach + 1> s;      // rows y-2 ... y+2
  std::array<const float*, 2 * reach + 1> sigma;  // rows of the grid: not padded, null outside
  const float* z;                                 // row y
};

struct SupportKernel {
  // Counts the neighbours that support each of the pixels [begin, end), end - begin <= block.
  BODYSCAN_KERNEL void run(const RowWindow* window, int begin, int end, float scale, int* count) {
    const float* s = window->s[reach];
    const float* z = window->z;
    const int n = end - begin;
    for (int i = 0; i < n; ++i) count[i] = 0;
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        if (dx == 0 && dy == 0) continue;
        const float* other = window->s[reach + dy];
        const float limit = scale * distance[dy * dy + dx * dx];
        for (int i = 0; i < n; ++i) {
          const int x = begin + i;
          const float jump = other[x + dx] - s[x];
          const float allowed = limit * z[x] * z[x];
          count[i] += (jump <= allowed) & (-jump <= allowed);
        }
      }
    }
  }

 private:
  static constexpr std::array<float, 9> distance = {0, 1, 1.4142136F, 0, 2, 2.2360680F, 0, 0, 2.8284271F};
};

struct ShapeKernel {
  // flying[i] = 1 for the pixels of [begin, end) that hang between surfaces or stand out of theirs.
  BODYSCAN_KERNEL void run(const RowWindow* window, int begin, int end, const Limits* limits, int* flying) {
    const float* up = window->s[reach - 1];
    const float* here = window->s[reach];
    const float* down = window->s[reach + 1];
    const float* sigma_here = window->sigma[reach];
    for (int i = 0; i < end - begin; ++i) {
      const int x = begin + i;
      const float s = here[x];
      const float z = window->z[x];
      const float z2 = z * z;
      const float left = here[x - 1] - s;
      const float right = here[x + 1] - s;
      const float above = up[x] - s;
      const float below = down[x] - s;
      float across = infinity;
      float along = infinity;
      across = left * left < across ? left * left : across;
      across = right * right < across ? right * right : across;
      along = above * above < along ? above * above : along;
      along = below * below < along ? below * below : along;
      const float steepness = (across < infinity ? across : 0) + (along < infinity ? along : 0);

      // Twice the height over the flattest line through both neighbours, or over the nearest neighbour.
      float spike = infinity;
      const float above_left = up[x - 1] - s;
      const float above_right = up[x + 1] - s;
      const float below_left = down[x - 1] - s;
      const float below_right = down[x + 1] - s;
      spike = least(spike, left + right, 2 * left, 2 * right);
      spike = least(spike, above + below, 2 * above, 2 * below);
      spike = least(spike, above_left + below_right, 2 * above_left, 2 * below_right);
      spike = least(spike, above_right + below_left, 2 * above_right, 2 * below_left);
      spike = spike < infinity ? spike : 0;

      const float footprint = limits->footprint * z;
      const float sigma = sigma_here[x] < footprint ? sigma_here[x] : footprint;
      flying[i] = (steepness > limits->flying_squared * z2 * z2) |
                  (spike > limits->spike * z2 + limits->spike_sigma * z * sigma);
    }
  }

 private:
  // The least of the magnitudes and `value`; a NaN does not count.
  BODYSCAN_KERNEL float least(float value, float p, float q, float r) {
    value = std::abs(p) < value ? std::abs(p) : value;
    value = std::abs(q) < value ? std::abs(q) : value;
    return std::abs(r) < value ? std::abs(r) : value;
  }
};

// A rim point is judged by the surface behind it: it flies if it lies off the line through the two points
// behind it in every direction in which there is no surface before it.
bool leaves_rim(const RowWindow& window, int x, const Limits& limits) {
  constexpr std::array<std::array<int, 2>, 8> directions{
      {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}};
  const auto row = [](int dy) { return reach + dy; };
  const auto s = [&](int dx, int dy) { return window.s[row(dy)][x + dx]; };
  const auto variance = [&](int dx, int dy) {
    const float sigma = window.sigma[row(dy)][x + dx];
    return sigma * sigma;
  };
  const float z = window.z[x];
  bool judged = false;
  for (const auto& [dx, dy] : directions) {
    const float length = dx != 0 && dy != 0 ? std::numbers::sqrt2_v<float> : 1.F;
    const bool open = !(std::abs(s(dx, dy) - s(0, 0)) <= length * limits.support * z * z);
    const float bend = std::abs(s(0, 0) - 2 * s(-dx, -dy) + s(-2 * dx, -2 * dy));
    if (!open || std::isnan(bend)) continue;
    const float noise = std::sqrt(variance(0, 0) + 4 * variance(-dx, -dy) + variance(-2 * dx, -2 * dy));
    if (bend <= limits.rim * z * z + limits.rim_sigma * z * noise) return false;
    judged = true;
  }
  return judged;
}

struct Removed {
  std::size_t points = 0;
  std::size_t isolated = 0;
  std::size_t flying = 0;
};

void judge_row(const RowWindow& window, int width, const Limits& limits, PointState* out, Removed& removed) {
  std::array<int, block> support;
  std::array<int, block> flying;
  for (int begin = 0; begin < width; begin += block) {
    const int end = std::min(width, begin + block);
    run_kernel<SupportKernel>(&window, begin, end, limits.support, support.data());
    run_kernel<ShapeKernel>(&window, begin, end, &limits, flying.data());
    for (int x = begin; x < end; ++x) {
      const auto i = static_cast<std::size_t>(x - begin);
      const bool absent = std::isnan(window.z[x]);
      const bool isolated = support[i] < limits.min_support;
      const bool flies =
          flying[i] || (!absent && !isolated && support[i] < 24 && leaves_rim(window, x, limits));
      out[x] = absent     ? PointState::absent
               : isolated ? PointState::isolated
               : flies    ? PointState::flying
                          : PointState::kept;
      removed.points += !absent;
      removed.isolated += out[x] == PointState::isolated;
      removed.flying += out[x] == PointState::flying;
    }
  }
}

// Rows [first, last), through a window of five rows that moves down.
Removed judge_rows(const PointGrid& grid, const Limits& limits, int first, int last,
                   Image<PointState>& states) {
  const int width = grid.points.width();
  const int height = grid.points.height();
  std::vector<RangeRow> rows(2 * reach + 1, RangeRow(width));
  const auto at = [&](int y) -> RangeRow& { return rows[(y + 2 * reach + 1) % (2 * reach + 1)]; };
  const auto load = [&](int y) {
    if (y < 0 || y >= height) return at(y).clear();
    run_kernel<RangeRowKernel>(grid.points.row(y), static_cast<const unsigned char*>(nullptr), width,
                               at(y).s(), at(y).z());
  };
  Removed removed;
  for (int y = first - reach; y < first + reach; ++y) load(y);
  for (int y = first; y < last; ++y) {
    load(y + reach);
    RowWindow window{.s = {}, .sigma = {}, .z = at(y).z()};
    for (int dy = -reach; dy <= reach; ++dy) {
      const int i = reach + dy;
      window.s[i] = at(y + dy).s();
      if (y + dy >= 0 && y + dy < height) window.sigma[i] = grid.sigma_mm.row(y + dy);
    }
    judge_row(window, width, limits, states.row(y), removed);
  }
  return removed;
}

float tangent(double degrees) {
  return static_cast<float>(std::tan(degrees * std::numbers::pi / 180));
}

}  // namespace

Expected<void> CleanOptions::check() const {
  const auto refuse = [](const char* what) {
    return tl::unexpected(Error{ErrorKind::usage, std::string("clean: ") + what});
  };
  if (!(support_incidence_deg > 0 && support_incidence_deg < 90)) {
    return refuse("support_incidence_deg: not between 0 and 90");
  }
  if (min_support < 0 || min_support > 24) return refuse("min_support: not between 0 and 24");
  if (!(flying_incidence_deg > 0 && flying_incidence_deg < 90)) {
    return refuse("flying_incidence_deg: not between 0 and 90");
  }
  if (!(spike_footprints > 0)) return refuse("spike_footprints: not positive");
  if (!(spike_sigmas >= 0)) return refuse("spike_sigmas: negative");
  if (!(rim_footprints > 0)) return refuse("rim_footprints: not positive");
  if (!(rim_sigmas >= 0)) return refuse("rim_sigmas: negative");
  return {};
}

Image<PointState> find_artifacts(const PointGrid& grid, const Lens& camera, const CleanOptions& options,
                                 CleanReport& report) {
  const auto focal = static_cast<float>(std::sqrt(camera.fx * camera.fy));
  const float flying = 2 * tangent(options.flying_incidence_deg) / focal;
  const Limits limits{.support = 2 * tangent(options.support_incidence_deg) / focal,
                      .flying_squared = flying * flying,
                      .spike = 4 * static_cast<float>(options.spike_footprints) / focal,
                      .spike_sigma = 4 * static_cast<float>(options.spike_sigmas),
                      .footprint = 1 / focal,
                      .min_support = options.min_support,
                      .rim = 2 * static_cast<float>(options.rim_footprints) / focal,
                      .rim_sigma = 2 * static_cast<float>(options.rim_sigmas)};
  Image<PointState> states(grid.points.size());
  std::atomic<std::size_t> points = 0;
  std::atomic<std::size_t> isolated = 0;
  std::atomic<std::size_t> flown = 0;
  parallel_for(0, grid.points.height(), 64, [&](int first, int last) {
    const Removed removed = judge_rows(grid, limits, first, last, states);
    points += removed.points;
    isolated += removed.isolated;
    flown += removed.flying;
  });
  report = {.points = points, .isolated_points = isolated, .flying_pixels = flown};
  return states;
}

}  // namespace bodyscan
