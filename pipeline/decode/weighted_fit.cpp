#include "pipeline/decode/weighted_fit.hpp"

#include "pipeline/base/instruction_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

namespace bodyscan {
namespace {

constexpr int unknowns = 6;  // 1, x, y, x^2, xy, y^2
constexpr float min_values = 2 * unknowns;
constexpr float max_gain = 0.9F;  // sigma of the fit in units of the middle value's
constexpr float max_stray = 2;    // root mean square of the residuals in units of the values' sigma

constexpr std::size_t powers = 5;  // of x for the weights: 1 to x^4; of x for the values: 1 to x^2
constexpr std::size_t lanes = 8;

// A row's sums: lanes 0 to 4 of w x^k, lanes 5 to 7 of w u x^k.
using Lanes = std::array<float, lanes>;

// For every radius and place in a row, x^k for the lanes; x in radii.
struct PowerTable {
  std::array<std::array<Lanes, 2 * WeightedSquare::max_radius + 1>, WeightedSquare::max_radius + 1> rows{};

  constexpr PowerTable() {
    for (int radius = 1; radius <= WeightedSquare::max_radius; ++radius) {
      for (int i = -radius; i <= radius; ++i) {
        Lanes& lane = rows[static_cast<std::size_t>(radius)][static_cast<std::size_t>(i + radius)];
        const float x = static_cast<float>(i) / static_cast<float>(radius);
        float power = 1;
        for (std::size_t k = 0; k < powers; ++k, power *= x) lane[k] = power;
        for (std::size_t k = powers; k < lanes; ++k) lane[k] = lane[k - powers];
      }
    }
  }
};
constexpr PowerTable table;

// Sums over a square of w x^i y^j, i + j <= 4, with w the weights, and of w u x^i y^j, i + j <= 2. x and y in
// radii, u above the middle's value.
struct Moments {
  std::array<std::array<float, powers>, powers> ones{};                    // [j][i]
  std::array<std::array<float, lanes - powers>, lanes - powers> values{};  // [j][i]
  float squares = 0;                                                       // of w u^2
  float count = 0;
};

struct SumMoments {
  BODYSCAN_KERNEL void run(const WeightedSquare* square, Moments* moments) {
    const int radius = square->radius;
    const float middle = *square->value;
    const Lanes* power = table.rows[static_cast<std::size_t>(radius)].data();
    for (int j = -radius; j <= radius; ++j) {
      const float* value = square->value + j * square->value_stride - radius;
      const float* weight = square->weight + j * square->weight_stride - radius;
      Lanes sum{};
      for (int i = 0; i <= 2 * radius; ++i) {
        const float w = weight[i];
        const float u = w > 0 ? value[i] - middle : 0;
        const float wu = w * u;
        const float term[lanes] = {w, w, w, w, w, wu, wu, wu};
        for (std::size_t k = 0; k < lanes; ++k) sum[k] += power[i][k] * term[k];
        moments->squares += wu * u;
        moments->count += w > 0 ? 1 : 0;
      }
      const Lanes& y = power[j + radius];
      for (std::size_t m = 0; m < powers; ++m)
        for (std::size_t k = 0; k + m < powers; ++k) moments->ones[m][k] += y[m] * sum[k];
      for (std::size_t m = 0; m < lanes - powers; ++m)
        for (std::size_t k = 0; k + m < lanes - powers; ++k) moments->values[m][k] += y[m] * sum[powers + k];
    }
  }
};

struct Term {
  std::size_t x;
  std::size_t y;
};
constexpr std::array<Term, unknowns> terms{Term{0, 0}, Term{1, 0}, Term{0, 1},
                                           Term{2, 0}, Term{1, 1}, Term{0, 2}};

}  // namespace

std::optional<WeightedFit> fit_weighted(const WeightedSquare& square) {
  Moments moments;
  run_kernel<SumMoments>(&square, &moments);
  if (moments.count < min_values) return std::nullopt;

  Eigen::Matrix<float, unknowns, unknowns> normal;
  Eigen::Matrix<float, unknowns, 1> right;
  for (int a = 0; a < unknowns; ++a) {
    const Term& one = terms[static_cast<std::size_t>(a)];
    right[a] = moments.values[one.y][one.x];
    for (int b = 0; b < unknowns; ++b) {
      const Term& other = terms[static_cast<std::size_t>(b)];
      normal(a, b) = moments.ones[one.y + other.y][one.x + other.x];
    }
  }
  const Eigen::LDLT<Eigen::Matrix<float, unknowns, unknowns>> solver(normal);
  if (solver.info() != Eigen::Success || solver.vectorD().minCoeff() < 1e-4F * moments.ones[0][0])
    return std::nullopt;
  const Eigen::Matrix<float, unknowns, 1> fit = solver.solve(right);
  const Eigen::Matrix<float, unknowns, 1> middle = solver.solve(Eigen::Matrix<float, unknowns, 1>::Unit(0));
  const float sigma = std::sqrt(std::max(middle[0], 0.0F));
  const float stray = (moments.squares - fit.dot(right)) / (moments.count - unknowns);
  if (!(sigma * sigma * *square.weight < max_gain * max_gain) || !(stray <= max_stray * max_stray))
    return std::nullopt;
  return WeightedFit{*square.value + fit[0], sigma};
}

}  // namespace bodyscan
