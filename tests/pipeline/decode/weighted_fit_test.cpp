#include "pipeline/decode/weighted_fit.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr int side = 17;
constexpr int center = side / 2;

class Square {
 public:
  explicit Square(const std::function<double(int x, int y)>& surface, float sigma = 0.05F) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        value_[index(x, y)] = static_cast<float>(surface(x - center, y - center));
        weight_[index(x, y)] = 1 / (sigma * sigma);
      }
    }
  }
  float& value(int x, int y) { return value_[index(x + center, y + center)]; }
  float& weight(int x, int y) { return weight_[index(x + center, y + center)]; }
  void leave_out(const std::function<bool(int x, int y)>& where) {
    for (int y = -center; y <= center; ++y) {
      for (int x = -center; x <= center; ++x) {
        if (!where(x, y)) continue;
        value(x, y) = std::numeric_limits<float>::quiet_NaN();
        weight(x, y) = 0;
      }
    }
  }
  [[nodiscard]] std::optional<WeightedFit> fit(int radius) const {
    const std::size_t middle = index(center, center);
    return fit_weighted({value_.data() + middle, side, weight_.data() + middle, side, radius});
  }

 private:
  static std::size_t index(int x, int y) { return static_cast<std::size_t>(y * side + x); }
  std::array<float, side * side> value_{};
  std::array<float, side * side> weight_{};
};

double bowl(int x, int y) {
  return 300 + 0.4 * x - 0.2 * y + 0.01 * x * x - 0.02 * x * y + 0.005 * y * y;
}

// Savitzky and Golay 1964: in one direction the middle weight of 2 r + 1 = 5, 7 and 17 points is 17 / 35,
// 7 / 21 and 43 / 323; the variance of a value fitted in both directions to a whole square is not their
// product, since x^2 y^2 and its like are left out, but no more than that.
TEST(WeightedFit, OfAWholeSquareIsNoWorseThanTheSeparableOne) {
  const Square square(bowl);
  for (const auto& [radius, gain] : {std::pair{2, 17 / 35.0}, {3, 7 / 21.0}, {8, 43 / 323.0}}) {
    const auto fit = square.fit(radius);
    ASSERT_TRUE(fit) << radius;
    EXPECT_NEAR(fit->value, bowl(0, 0), 1e-4);
    EXPECT_LE(fit->sigma, 1.001 * gain * 0.05);
    EXPECT_GE(fit->sigma, 0.5 * gain * 0.05);
  }
}

TEST(WeightedFit, GapsLeaveTheValueAndRaiseSigma) {
  Square square(bowl);
  const float whole = square.fit(4)->sigma;
  square.leave_out([](int x, int y) { return x > 0 || (x + y) % 5 == 1; });
  const auto fit = square.fit(4);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->value, bowl(0, 0), 2e-4);
  EXPECT_GT(fit->sigma, 1.5F * whole);
  EXPECT_LT(fit->sigma, 0.9F * 0.05F);
}

TEST(WeightedFit, SigmaIsTheScatterOfTheValue) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  constexpr int trials = 400;
  double squares = 0;
  float sigma = 0;
  for (int i = 0; i < trials; ++i) {
    Square square([&](int x, int y) { return bowl(x, y) + 0.05 * (y > 1 ? 3 : 1) * normal(random); });
    for (int y = 2; y <= center; ++y)
      for (int x = -center; x <= center; ++x) square.weight(x, y) /= 9;
    square.leave_out([](int x, int) { return x < -1; });
    const auto fit = square.fit(5);
    ASSERT_TRUE(fit);
    squares += std::pow(fit->value - bowl(0, 0), 2);
    sigma = fit->sigma;
  }
  EXPECT_NEAR(std::sqrt(squares / trials) / sigma, 1, 0.12);
}

TEST(WeightedFit, TooFewOrLopsidedValuesGiveNothing) {
  Square few(bowl);
  few.leave_out([](int x, int y) { return std::abs(x) > 1 || std::abs(y) > 1; });
  EXPECT_FALSE(few.fit(5));
  Square line(bowl);
  line.leave_out([](int, int y) { return y != 0; });
  EXPECT_FALSE(line.fit(8));
  Square strip(bowl);
  strip.leave_out([](int, int y) { return y < 0 || y > 1; });
  EXPECT_FALSE(strip.fit(8));
}

TEST(WeightedFit, AJumpInTheSquareGivesNothing) {
  Square jump([](int x, int y) { return bowl(x, y) + (x + y > 2 ? 1.5 : 0); });
  EXPECT_FALSE(jump.fit(4));
  EXPECT_TRUE(Square(bowl).fit(4));
}

}  // namespace
}  // namespace bodyscan
