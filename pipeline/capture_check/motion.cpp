#include "pipeline/capture_check/motion.hpp"

#include "pipeline/base/median.hpp"
#include "pipeline/decode/response.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include <Eigen/Eigenvalues>

namespace bodyscan {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr int reduced_width = 1000;
constexpr int tile = 32;
constexpr int border = 6;  // reduced px: as far as a tile may be followed
constexpr int max_iterations = 12;
constexpr double converged = 0.005;    // reduced px
constexpr double max_sigma = 0.1;      // reduced px
constexpr double least_noise = 0.003;  // of full scale: less is not believed
constexpr double unseen_noise =
    4;  // times the variance that the mask sees: JPEG leaves the smooth part of noise
constexpr double elsewhere = 1;  // reduced px: what fits nowhere and seems to have moved more has moved

float at(const FloatImage& image, double x, double y) {
  const int left = static_cast<int>(std::floor(x));
  const int top = static_cast<int>(std::floor(y));
  const auto across = static_cast<float>(x - left);
  const auto down = static_cast<float>(y - top);
  const float* upper = image.row(top) + left;
  const float* lower = image.row(top + 1) + left;
  return (1 - down) * ((1 - across) * upper[0] + across * upper[1]) +
         down * ((1 - across) * lower[0] + across * lower[1]);
}

// Variance of the noise in a tile (Immerkaer 1996, eq. 2: a mask that sees no plane and no straight edge
// along the axes).
double noise_variance(const FloatImage& image, int left, int top) {
  double squares = 0;
  for (int y = top; y < top + tile; ++y) {
    const float* above = image.row(y - 1);
    const float* here = image.row(y);
    const float* below = image.row(y + 1);
    for (int x = left; x < left + tile; ++x) {
      const float corners = above[x - 1] + above[x + 1] + below[x - 1] + below[x + 1];
      const float sides = above[x] + below[x] + here[x - 1] + here[x + 1];
      const double response = corners - 2 * sides + 4 * here[x];
      squares += response * response;
    }
  }
  return unseen_noise * squares / (36.0 * tile * tile);
}

struct Alignment {
  Matrix2d structure = Matrix2d::Zero();  // sum of gradient products
  Vector2d pull = Vector2d::Zero();       // sum of gradient times brightness difference
  double squares = 0;                     // of the brightness difference
};

// `after` is read `moved` further on. A brightness that all of the tile gains, as a share of it or as such,
// is no motion: sums are of what is left once both were fitted.
Alignment align(const FloatImage& before, const FloatImage& after, int left, int top, const Vector2d& moved) {
  Alignment sum;
  Vector2d gradients = Vector2d::Zero();
  Vector2d gradients_by_light = Vector2d::Zero();
  double lights = 0;
  double light_squares = 0;
  double differences = 0;
  double differences_by_light = 0;
  for (int y = top; y < top + tile; ++y) {
    for (int x = left; x < left + tile; ++x) {
      const Vector2d gradient((before(x + 1, y) - before(x - 1, y)) / 2,
                              (before(x, y + 1) - before(x, y - 1)) / 2);
      const double light = before(x, y);
      const double difference = at(after, x + moved.x(), y + moved.y()) - light;
      sum.structure += gradient * gradient.transpose();
      sum.pull += gradient * difference;
      sum.squares += difference * difference;
      gradients += gradient;
      gradients_by_light += gradient * light;
      lights += light;
      light_squares += light * light;
      differences += difference;
      differences_by_light += difference * light;
    }
  }
  constexpr double count = tile * tile;
  sum.structure -= gradients * gradients.transpose() / count;
  sum.pull -= gradients * (differences / count);
  sum.squares -= differences * differences / count;
  const double spread = light_squares - lights * lights / count;
  if (spread > 0) {
    const Vector2d gradient_with_light = gradients_by_light - gradients * (lights / count);
    const double difference_with_light = differences_by_light - differences * (lights / count);
    sum.structure -= gradient_with_light * gradient_with_light.transpose() / spread;
    sum.pull -= gradient_with_light * (difference_with_light / spread);
    sum.squares -= difference_with_light * difference_with_light / spread;
  }
  sum.squares = std::max(0.0, sum.squares);
  return sum;
}

struct Step {
  Vector2d moved = Vector2d::Zero();
  bool told = false;  // by the structure, in some direction
  bool fits = false;  // what is there, to the noise that the structure bears
};

// The step that aligns, along the directions that the structure tells. The noise's own structure,
// half its variance a pixel, tells nothing.
Step step_of(const Alignment& sum, double variance_before, double variance_after) {
  const Eigen::SelfAdjointEigenSolver<Matrix2d> directions(sum.structure);
  const double noise = std::max(least_noise, std::sqrt(variance_before + variance_after));
  Step step;
  for (int i = 0; i < 2; ++i) {
    const double strength = directions.eigenvalues()[i] - tile * tile * variance_before / 2;
    if (!(strength > 0) || noise / std::sqrt(strength) > max_sigma) continue;
    const Vector2d direction = directions.eigenvectors().col(i);
    step.moved -= direction * direction.dot(sum.pull) / directions.eigenvalues()[i];
    step.told = true;
    step.fits |= std::sqrt(sum.squares / strength) / tile <= max_sigma;
  }
  return step;
}

// Nothing where the structure tells none, or where something else is seen at the same place.
std::optional<Vector2d> follow(const FloatImage& before, const FloatImage& after, int left, int top) {
  const double variance_before = noise_variance(before, left, top);
  const double variance_after = noise_variance(after, left, top);
  Vector2d moved = Vector2d::Zero();
  Step step;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    step = step_of(align(before, after, left, top, moved), variance_before, variance_after);
    if (!step.told) return std::nullopt;
    moved += step.moved;
    if (moved.cwiseAbs().maxCoeff() > border - 1) return moved.normalized() * border;  // too far to follow
    if (step.moved.norm() < converged) break;
  }
  if (!step.fits && moved.norm() < elsewhere) return std::nullopt;
  return moved;
}

// A body moves together, noise does not: each tile moves as the median of itself and its neighbours. Tiles
// with fewer than two neighbours are left out.
std::vector<TileMotion> together(const std::vector<TileMotion>& tiles, double reach) {
  std::vector<TileMotion> result;
  for (const TileMotion& here : tiles) {
    std::vector<double> across;
    std::vector<double> down;
    for (const TileMotion& other : tiles) {
      if ((other.at - here.at).cwiseAbs().maxCoeff() > reach) continue;
      across.push_back(other.moved.x());
      down.push_back(other.moved.y());
    }
    if (across.size() > 2) result.push_back({here.at, {median(across), median(down)}});
  }
  return result;
}

}  // namespace

int motion_factor(Size photograph) {
  return std::max(1, photograph.width / reduced_width);
}

FloatImage reduce(const Luma& photograph, int factor, const ToneResponse& response) {
  return std::visit(
      [&](const auto& image) {
        using Pixel = std::remove_cvref_t<decltype(image(0, 0))>;
        const std::vector<std::uint16_t> linear = linear_table(response, 8 * static_cast<int>(sizeof(Pixel)));
        FloatImage reduced({image.width() / factor, image.height() / factor}, 0);
        const float scale = 1 / static_cast<float>(factor * factor * linear_full_scale);
        std::vector<std::uint32_t> sums(static_cast<std::size_t>(reduced.width()));
        for (int y = 0; y < reduced.height(); ++y) {
          std::ranges::fill(sums, 0U);
          for (int row = y * factor; row < (y + 1) * factor; ++row)
            for (int x = 0; x < reduced.width() * factor; ++x)
              sums[static_cast<std::size_t>(x / factor)] += linear[image(x, row)];
          for (int x = 0; x < reduced.width(); ++x)
            reduced(x, y) = scale * static_cast<float>(sums[static_cast<std::size_t>(x)]);
        }
        return reduced;
      },
      photograph);
}

std::vector<TileMotion> motion_between(const FloatImage& before, const FloatImage& after, int factor) {
  std::vector<TileMotion> tiles;
  for (int top = border; top + tile + border < before.height(); top += tile) {
    for (int left = border; left + tile + border < before.width(); left += tile) {
      if (const std::optional<Vector2d> moved = follow(before, after, left, top))
        tiles.push_back({factor * Vector2d(left + tile / 2, top + tile / 2), factor * *moved});
    }
  }
  return together(tiles, 1.5 * factor * tile);
}

double usual_motion_px(const std::vector<TileMotion>& tiles) {
  if (tiles.empty()) return 0;
  std::vector<double> lengths;
  for (const TileMotion& motion : tiles) lengths.push_back(motion.moved.norm());
  const auto place = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() * 9 / 10);
  std::nth_element(lengths.begin(), place, lengths.end());
  return *place;
}

}  // namespace bodyscan
