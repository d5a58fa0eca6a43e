#include "pipeline/capture_check/motion.hpp"

#include "pipeline/decode/response.hpp"

#include <algorithm>
#include <cmath>
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

struct Alignment {
  Matrix2d structure = Matrix2d::Zero();  // sum of gradient products
  Vector2d pull = Vector2d::Zero();       // sum of gradient times brightness difference
  double squares = 0;                     // of the brightness difference
};

// `after` is read `moved` further on.
Alignment align(const FloatImage& before, const FloatImage& after, int left, int top, const Vector2d& moved) {
  Alignment sum;
  for (int y = top; y < top + tile; ++y) {
    for (int x = left; x < left + tile; ++x) {
      const Vector2d gradient((before(x + 1, y) - before(x - 1, y)) / 2,
                              (before(x, y + 1) - before(x, y - 1)) / 2);
      const double difference = at(after, x + moved.x(), y + moved.y()) - before(x, y);
      sum.structure += gradient * gradient.transpose();
      sum.pull += gradient * difference;
      sum.squares += difference * difference;
    }
  }
  return sum;
}

// The step that aligns, along the directions that the structure tells; nothing where it tells none.
bool step_of(const Alignment& sum, Vector2d& step) {
  const Eigen::SelfAdjointEigenSolver<Matrix2d> directions(sum.structure);
  const double noise = std::max(least_noise, std::sqrt(sum.squares) / tile);
  step = Vector2d::Zero();
  bool told = false;
  for (int i = 0; i < 2; ++i) {
    const double strength = directions.eigenvalues()[i];
    if (!(strength > 0) || noise / std::sqrt(strength) > max_sigma) continue;
    const Vector2d direction = directions.eigenvectors().col(i);
    step -= direction * direction.dot(sum.pull) / strength;
    told = true;
  }
  return told;
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
      Vector2d moved = Vector2d::Zero();
      Vector2d step = Vector2d::Zero();
      bool told = false;
      for (int iteration = 0; iteration < max_iterations; ++iteration) {
        told = step_of(align(before, after, left, top, moved), step);
        if (!told) break;
        moved += step;
        if (moved.cwiseAbs().maxCoeff() > border - 1 || step.norm() < converged) break;
      }
      // A tile that cannot be followed to an end moved too far, or shows something else.
      if (!told && moved.isZero()) continue;
      if (moved.cwiseAbs().maxCoeff() > border - 1) moved = moved.normalized() * border;
      tiles.push_back({factor * Vector2d(left + tile / 2, top + tile / 2), factor * moved});
    }
  }
  return tiles;
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
