#include "pipeline/decode/edge_profile.hpp"

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

using Density = std::array<double, bins>;

// Binomial passes over the tiles: the window must fade out, since a hard edge cuts through stripes and makes
// some positions in them more frequent than others. Doubled with each dropped bit, as the stripes are.
constexpr int blur_passes = 4;

// One pass of 1 2 1 in both directions; what lies beyond the border counts as empty.
void blur(Image<Density>& tiles) {
  const auto pass = [](Density* first, std::ptrdiff_t stride, int count) {
    Density before{};
    for (int i = 0; i < count; ++i) {
      Density& here = first[i * stride];
      const Density old = here;
      for (std::size_t bin = 0; bin < bins; ++bin)
        here[bin] = 2 * old[bin] + before[bin] + (i + 1 < count ? first[(i + 1) * stride][bin] : 0);
      before = old;
    }
  };
  for (int y = 0; y < tiles.height(); ++y) pass(tiles.row(y), 1, tiles.width());
  for (int x = 0; x < tiles.width(); ++x) pass(tiles.data() + x, tiles.width(), tiles.height());
  for (Density& tile : tiles.pixels())
    for (double& count : tile) count /= 16;
}

// Least-squares fit of the cumulative distribution at the bin edges.
std::array<float, terms> fit(const Density& density) {
  double total = 0;
  for (const double count : density) total += count;
  std::array<float, terms> coefficients{};
  if (total <= 0) return coefficients;

  Eigen::Matrix<double, terms, terms> normal = Eigen::Matrix<double, terms, terms>::Identity() * 1e-6;
  Eigen::Matrix<double, terms, 1> right = Eigen::Matrix<double, terms, 1>::Zero();
  double below = 0;
  for (std::size_t bin = 0; bin + 1 < bins; ++bin) {
    below += density[bin];
    const double ratio = static_cast<double>(bin + 1) / bins;
    const double weight = (density[bin] + density[bin + 1]) / total + 0.2 / bins;
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

}  // namespace

EdgeProfile::Histogram::Histogram(Size camera)
    : counts_({(camera.width + tile_px - 1) / tile_px, (camera.height + tile_px - 1) / tile_px}, Counts{}) {}

void EdgeProfile::Histogram::add_run(int y, int begin, int end, const float* ratios,
                                     const std::uint16_t* cells) {
  auto* tiles = counts_.row(y / tile_px);
  for (int x = begin; x < end; ++x) {
    if (std::isnan(ratios[x])) continue;
    const int bin = std::min(static_cast<int>(ratios[x] * bins), bins - 1);
    ++tiles[x / tile_px][kind_of(cells[x])][static_cast<std::size_t>(bin)];
  }
}

EdgeProfile::EdgeProfile(const Histogram& histogram, int dropped) : tiles_(histogram.counts_.size()) {
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    Image<Density> densities(tiles_.size());
    Density whole{};
    double whole_total = 1e-9;
    for (std::size_t i = 0; i < densities.size().area(); ++i) {
      for (std::size_t bin = 0; bin < bins; ++bin) {
        const double count = histogram.counts_.data()[i][kind][bin];
        densities.data()[i][bin] = count;
        whole[bin] += count;
        whole_total += count;
      }
    }
    for (int pass = 0; pass < blur_passes << dropped; ++pass) blur(densities);
    for (std::size_t i = 0; i < densities.size().area(); ++i) {
      Density density = densities.data()[i];
      for (std::size_t bin = 0; bin < bins; ++bin) density[bin] += prior_samples * whole[bin] / whole_total;
      tiles_.data()[i][kind] = fit(density);
    }
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
      for (int i = 0; i < stop - x; ++i) out[x + i] = start + step * static_cast<float>(i);
      x = stop;
    }
  }
}

}  // namespace bodyscan
