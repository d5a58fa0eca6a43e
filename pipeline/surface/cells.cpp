#include "pipeline/surface/cells.hpp"

#include "pipeline/base/parallel.hpp"
#include "pipeline/surface/range_rows.hpp"

#include <atomic>
#include <cmath>
#include <numbers>
#include <utility>

namespace bodyscan {
namespace {

// The options, for squared ranges (range_rows.hpp).
struct Limits {
  float edge_squared;  // times (z1 + z2)^4
  float variance;      // times (z1 + z2)^2 times the sum of both variances
  float area_squared;  // times z^4
};

struct RowPair {
  const float* s;
  const float* z;
  const float* variance;
  const float* s_below;
  const float* z_below;
  const float* variance_below;
};

struct RowCounts {
  int edges_cut = 0;
  int faces_removed = 0;
};

struct CellKernel {
  BODYSCAN_KERNEL void run(const RowPair* rows, int width, const Limits* limits, std::uint8_t* cells,
                           RowCounts* counts) {
    const RowPair row = *rows;
    const Limits limit = *limits;
    int cut = 0;
    int removed = 0;
    for (int x = 0; x < width; ++x) {
      const Corner a{row.s[x], row.z[x], row.variance[x]};
      const Corner b{row.s[x + 1], row.z[x + 1], row.variance[x + 1]};
      const Corner c{row.s_below[x], row.z_below[x], row.variance_below[x]};
      const Corner d{row.s_below[x + 1], row.z_below[x + 1], row.variance_below[x + 1]};
      const float ab = square(a.s - b.s);
      const float cd = square(c.s - d.s);
      const float ac = square(a.s - c.s);
      const float bd = square(b.s - d.s);
      const float ad = square(a.s - d.s);
      const float bc = square(b.s - c.s);
      const int join_ab = ab <= allowed(a, b, 1, limit);
      const int join_cd = cd <= allowed(c, d, 1, limit);
      const int join_ac = ac <= allowed(a, c, 1, limit);
      const int join_bd = bd <= allowed(b, d, 1, limit);
      const int join_ad = ad <= allowed(a, d, 2, limit);
      const int join_bc = bc <= allowed(b, c, 2, limit);
      const int acd = join_ac & join_cd & join_ad;
      const int adb = join_ad & join_bd & join_ab;
      const int acb = join_ac & join_bc & join_ab;
      const int bcd = join_bc & join_cd & join_bd;
      const int anti = (acb + bcd > acd + adb) | ((acb + bcd == acd + adb) & (bc < ad));
      // The squared tangent of a triangle's incidence is the sum of those of its two perpendicular edges.
      const float largest = limit.area_squared * square(square(a.z));
      const float largest_anti = limit.area_squared * square(square(b.z));
      const int small_acd = acd & (ac + cd <= largest);
      const int small_adb = adb & (ab + bd <= largest);
      const int small_acb = acb & (ac + ab <= largest_anti);
      const int small_bcd = bcd & (bd + cd <= largest_anti);
      // Chosen by arithmetic: a branch would keep the compiler from vectorising.
      const int first = small_acd + anti * (small_acb - small_acd);
      const int second = small_adb + anti * (small_bcd - small_adb);
      const int with_edges = acd + adb + anti * (acb + bcd - acd - adb);
      removed += with_edges - first - second;
      cut += ((a.z + b.z > 0) & (join_ab ^ 1)) + ((a.z + c.z > 0) & (join_ac ^ 1));
      cells[x] = static_cast<std::uint8_t>(first | second << 1 | (anti & (first | second)) << 2);
    }
    counts->edges_cut += cut;
    counts->faces_removed += removed;
  }

 private:
  struct Corner {
    float s;
    float z;
    float variance;
  };

  BODYSCAN_KERNEL float square(float value) { return value * value; }

  // The largest square of a jump in s between two corners; length in pixels. Squares, so that the noise needs
  // no root: jump <= edge + noise is taken as jump^2 <= edge^2 + noise^2.
  BODYSCAN_KERNEL float allowed(const Corner& p, const Corner& q, float squared_length, const Limits& limit) {
    const float depth2 = square(p.z + q.z);
    return depth2 *
           (squared_length * limit.edge_squared * depth2 + limit.variance * (p.variance + q.variance));
  }
};

struct VarianceKernel {
  // Squared standard deviations, none above a pixel's footprint: what is less certain proves no connection.
  BODYSCAN_KERNEL void run(const float* sigma, const float* z, int width, float footprint, float* variance) {
    for (int x = 0; x < width; ++x) {
      const float largest = footprint * z[x];
      const float deviation = sigma[x] < largest ? sigma[x] : largest;
      variance[x] = deviation * deviation;
    }
  }
};

float tangent(double degrees) {
  return static_cast<float>(std::tan(degrees * std::numbers::pi / 180));
}

// Two rows of the grid as the kernel wants them, moving down; below the last row there is nothing.
class CellRows {
 public:
  CellRows(const PointGrid& grid, const Image<PointState>& states, float footprint, int first)
      : grid_(grid),
        states_(states),
        footprint_(footprint),
        here_(width()),
        below_(width()),
        variance_(static_cast<std::size_t>(width()) + 1, 0.F),
        variance_below_(variance_) {
    load(first);
  }

  RowPair advance_to(int y) {
    std::swap(here_, below_);
    std::swap(variance_, variance_below_);
    load(y + 1);
    return {here_.s(), here_.z(), variance_.data(), below_.s(), below_.z(), variance_below_.data()};
  }

 private:
  [[nodiscard]] int width() const { return grid_.points.width(); }

  void load(int y) {
    if (y >= grid_.points.height()) return below_.clear();
    run_kernel<RangeRowKernel>(grid_.points.row(y), reinterpret_cast<const unsigned char*>(states_.row(y)),
                               width(), below_.s(), below_.z());
    run_kernel<VarianceKernel>(grid_.sigma_mm.row(y), std::as_const(below_).z(), width(), footprint_,
                               variance_below_.data());
  }

  const PointGrid& grid_;
  const Image<PointState>& states_;
  float footprint_;
  RangeRow here_;
  RangeRow below_;
  std::vector<float> variance_;  // one longer than a row: the kernel looks at the pixel to the right
  std::vector<float> variance_below_;
};

}  // namespace

Expected<void> MeshOptions::check() const {
  const auto refuse = [](const char* what) {
    return tl::unexpected(Error{ErrorKind::usage, std::string("mesh: ") + what});
  };
  if (!(max_incidence_deg > 0 && max_incidence_deg < 90)) {
    return refuse("max_incidence_deg: not between 0 and 90");
  }
  if (!(noise_sigmas >= 0)) return refuse("noise_sigmas: negative");
  if (!(max_area > 1)) return refuse("max_area: not above 1");
  return {};
}

Image<std::uint8_t> connect_cells(const PointGrid& grid, const Image<PointState>& states, const Lens& camera,
                                  const MeshOptions& options, MeshReport& report) {
  const auto focal = static_cast<float>(std::sqrt(camera.fx * camera.fy));
  const auto area = static_cast<float>(options.max_area);
  const float edge = tangent(options.max_incidence_deg) / (2 * focal);
  const auto sigmas = static_cast<float>(options.noise_sigmas);
  const Limits limits{.edge_squared = edge * edge,
                      .variance = sigmas * sigmas,
                      .area_squared = (area * area - 1) * 4 / (focal * focal)};
  Image<std::uint8_t> cells(grid.points.size());
  std::atomic<std::size_t> cut = 0;
  std::atomic<std::size_t> removed = 0;
  parallel_for(0, grid.points.height(), 64, [&](int begin, int end) {
    CellRows rows(grid, states, 1 / focal, begin);
    for (int y = begin; y < end; ++y) {
      const RowPair pair = rows.advance_to(y);
      RowCounts counts;
      run_kernel<CellKernel>(&pair, grid.points.width(), &limits, cells.row(y), &counts);
      cut += static_cast<std::size_t>(counts.edges_cut);
      removed += static_cast<std::size_t>(counts.faces_removed);
    }
  });
  report = {.edges_cut = cut, .faces_removed_by_area = removed};
  return cells;
}

}  // namespace bodyscan
