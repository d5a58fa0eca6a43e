#include "pipeline/decode/edge_profile.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace bodyscan {
namespace {

constexpr int bins = EdgeProfile::Histogram::bins;
constexpr int terms = EdgeProfile::terms;

// Samples of the whole picture that every tile's own are mixed with: they decide where a tile has hardly any,
// and keep a tile honest whose stripes lock to the camera's pixels.
constexpr double prior_samples = 300;

using Density = std::array<float, bins>;

// Binomial passes over the tiles: the window must fade out, since a hard edge cuts through stripes and makes
// some positions in them more frequent than others. Doubled with each dropped bit, as the stripes are.
constexpr int blur_passes = 4;

// 1 2 1 over four, along `count` tiles that lie `stride` apart; what lies beyond the border counts as empty.
struct BlurLine {
  BODYSCAN_KERNEL void run(Density* first, std::ptrdiff_t stride, int count) {
    Density before{};
    for (int i = 0; i < count; ++i) {
      Density& here = first[i * stride];
      const Density& after = first[(i + 1 < count ? i + 1 : i) * stride];
      const float has_after = i + 1 < count ? 0.25F : 0;
      BODYSCAN_VECTORIZE
      for (std::size_t bin = 0; bin < bins; ++bin) {
        const float old = here[bin];
        here[bin] = 0.5F * old + 0.25F * before[bin] + has_after * after[bin];
        before[bin] = old;
      }
    }
  }
};

// One pass in both directions.
void blur(Image<Density>& tiles) {
  parallel_for(0, tiles.height(), 4, [&](int first, int last) {
    for (int y = first; y < last; ++y) run_kernel<BlurLine>(tiles.row(y), 1, tiles.width());
  });
  parallel_for(0, tiles.width(), 4, [&](int first, int last) {
    for (int x = first; x < last; ++x) run_kernel<BlurLine>(tiles.data() + x, tiles.width(), tiles.height());
  });
}

// Least-squares fit of the cumulative distribution at the bin edges.
std::array<float, terms> fit(const Density& density) {
  double total = 0;
  for (const float count : density) total += static_cast<double>(count);
  std::array<float, terms> coefficients{};
  if (total <= 0) return coefficients;

  Eigen::Matrix<double, terms, terms> normal = Eigen::Matrix<double, terms, terms>::Identity() * 1e-6;
  Eigen::Matrix<double, terms, 1> right = Eigen::Matrix<double, terms, 1>::Zero();
  double below = 0;
  for (std::size_t bin = 0; bin + 1 < bins; ++bin) {
    below += static_cast<double>(density[bin]);
    const double ratio = static_cast<double>(bin + 1) / bins;
    const double weight = static_cast<double>(density[bin] + density[bin + 1]) / total + 0.2 / bins;
    Eigen::Matrix<double, terms, 1> basis;
    double value = ratio * (1 - ratio);
    for (int term = 0; term < terms; ++term, value *= 2 * ratio - 1) basis[term] = value;
    normal += weight * basis * basis.transpose();
    right += weight * (below / total - ratio) * basis;
  }
  const Eigen::Matrix<double, terms, 1> solution = normal.ldlt().solve(right);
  for (int term = 0; term < terms; ++term)
    coefficients[static_cast<std::size_t>(term)] = static_cast<float>(solution[term]);
  return coefficients;
}

// Index in Histogram::Counts.
struct PlaceInHistogram {
  BODYSCAN_KERNEL void run(int count, const float* ratios, const std::uint16_t* cells,
                           std::uint16_t* places) {
    BODYSCAN_VECTORIZE
    for (int i = 0; i < count; ++i) {
      const bool there = ratios[i] == ratios[i];
      const int bin = static_cast<int>((there ? ratios[i] : 0) * bins);
      const int inside = bin < bins - 1 ? bin : bins - 1;
      const int place = static_cast<int>(EdgeProfile::kind_of(cells[i])) * bins + inside;
      places[i] = static_cast<std::uint16_t>(there ? place : EdgeProfile::kinds * bins);
    }
  }
};

struct Ramp {
  BODYSCAN_KERNEL void run(int count, float start, float step, float* values) {
    BODYSCAN_VECTORIZE
    for (int i = 0; i < count; ++i) values[i] = start + step * static_cast<float>(i);
  }
};

}  // namespace

EdgeProfile::Histogram::Histogram(Size camera)
    : counts_({(camera.width + tile_px - 1) / tile_px, (camera.height + tile_px - 1) / tile_px}, Counts{}) {}

void EdgeProfile::Histogram::add_run(int y, int begin, int end, const float* ratios,
                                     const std::uint16_t* cells) {
  std::array<std::uint16_t, tile_px> places;
  for (int x = begin; x < end;) {
    const int stop = std::min(end, (x / tile_px + 1) * tile_px);
    run_kernel<PlaceInHistogram>(stop - x, ratios + x, cells + x, places.data());
    Counts& counts = counts_(x / tile_px, y / tile_px);
    for (int i = 0; i < stop - x; ++i) ++counts[places[static_cast<std::size_t>(i)]];
    x = stop;
  }
}

EdgeProfile::EdgeProfile(const Histogram& histogram, int dropped) : tiles_(histogram.counts_.size()) {
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    Image<Density> densities(tiles_.size());
    std::array<double, bins> whole{};
    double whole_total = 1e-9;
    for (std::size_t i = 0; i < densities.size().area(); ++i) {
      for (std::size_t bin = 0; bin < bins; ++bin) {
        const std::uint32_t count = histogram.counts_.data()[i][kind * bins + bin];
        densities.data()[i][bin] = static_cast<float>(count);
        whole[bin] += count;
        whole_total += count;
      }
    }
    for (int pass = 0; pass < blur_passes << dropped; ++pass) blur(densities);
    parallel_for(0, tiles_.height(), 1, [&](int first, int last) {
      for (int y = first; y < last; ++y) {
        for (int x = 0; x < tiles_.width(); ++x) {
          Density density = densities(x, y);
          for (std::size_t bin = 0; bin < bins; ++bin)
            density[bin] += static_cast<float>(prior_samples * whole[bin] / whole_total);
          tiles_(x, y)[kind] = fit(density);
        }
      }
    });
  }
}

void EdgeProfile::coefficients_of_row(int y, int width, float* coefficients) const {
  const auto position = [](int pixel, int tiles) {
    return std::clamp((static_cast<float>(pixel) + 0.5F) / tile_px - 0.5F, 0.0F,
                      static_cast<float>(tiles - 1));
  };
  const float v = position(y, tiles_.height());
  const int top = static_cast<int>(v);
  const int bottom = std::min(top + 1, tiles_.height() - 1);
  const float down = v - static_cast<float>(top);
  for (std::size_t term = 0; term < kinds * terms; ++term) {
    const auto column = [&](int tx) {
      return tiles_(tx, top)[term / terms][term % terms] * (1 - down) +
             tiles_(tx, bottom)[term / terms][term % terms] * down;
    };
    float* out = coefficients + term * static_cast<std::size_t>(width);
    for (int x = 0; x < width;) {
      const float u = position(x, tiles_.width());
      const int left = static_cast<int>(u);
      const float a = column(left);
      const float b = column(std::min(left + 1, tiles_.width() - 1));
      // Up to the centre of the next tile the coefficients are one ramp (constant before the first centre and
      // after the last).
      const bool before = x < tile_px / 2;
      const int end = before                      ? tile_px / 2
                      : left + 1 < tiles_.width() ? (left + 1) * tile_px + tile_px / 2
                                                  : width;
      const float step = before || left + 1 >= tiles_.width() ? 0 : (b - a) / tile_px;
      const float start = a + (u - static_cast<float>(left)) * (b - a);
      const int stop = std::min(end, width);
      run_kernel<Ramp>(stop - x, start, step, out + x);
      x = stop;
    }
  }
}

}  // namespace bodyscan
