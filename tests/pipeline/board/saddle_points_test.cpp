#include "pipeline/board/saddle_points.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr double degree = std::numbers::pi / 180;
const Vector2d middle(30.3, 29.8);

double softened(double distance) {
  return (1 + std::erf(distance / std::sqrt(2.0))) / 2;
}

// Four squares that meet at `middle`, blurred by a pixel, 50 and 200; right of and below it bright. The edges
// lie at `first` and `second` degrees.
FloatImage four_squares(double first, double second) {
  FloatImage image({60, 60});
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 60; ++x) {
      const Vector2d at = Vector2d(x, y) - middle;
      const double a = softened(at.y() * std::cos(first * degree) - at.x() * std::sin(first * degree));
      const double b = softened(at.x() * std::sin(second * degree) - at.y() * std::cos(second * degree));
      image(x, y) = static_cast<float>(50 + 150 * (a * b + (1 - a) * (1 - b)));
    }
  }
  return image;
}

FloatImage drawn(float (*grey)(int x, int y)) {
  FloatImage image({60, 60});
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) image(x, y) = grey(x, y);
  return image;
}

double angle_to(const Vector2d& edge, double degrees) {
  return std::acos(std::min(1.0, std::abs(edge.dot(Vector2d(std::cos(degrees * degree),  //
                                                            std::sin(degrees * degree)))))) /
         degree;
}

TEST(SaddlePoints, FourSquaresMeetInOne) {
  const auto saddles = find_saddle_points(four_squares(0, 90), {});
  ASSERT_EQ(saddles.size(), 1U);
  EXPECT_LT((saddles[0].at - middle).norm(), 0.05);
  EXPECT_NEAR(saddles[0].strength, 0.64, 0.1F);
}

TEST(SaddlePoints, EdgesRunBetweenTheSquares) {
  for (const auto& [first, second] : {std::pair(0.0, 90.0), {20.0, 110.0}, {-35.0, 55.0}}) {
    const auto saddles = find_saddle_points(four_squares(first, second), {});
    ASSERT_EQ(saddles.size(), 1U) << first << " " << second;
    const auto& edges = saddles[0].edges;
    EXPECT_LT(std::min(angle_to(edges[0], first), angle_to(edges[1], first)), 4) << first << " " << second;
    EXPECT_LT(std::min(angle_to(edges[0], second), angle_to(edges[1], second)), 4) << first << " " << second;
  }
}

TEST(SaddlePoints, TellWhereItIsBright) {
  FloatImage image = four_squares(20, 110);
  const auto saddles = find_saddle_points(image, {});
  ASSERT_EQ(saddles.size(), 1U);
  // edges[1] points down to the right, edges[0] up to it: 20 and -70 degrees, bright is 20 to 110.
  EXPECT_LT(angle_to(saddles[0].edges[0], -70), 4);
  EXPECT_FALSE(saddles[0].positive);
  for (float& value : image.pixels()) value = 250 - value;
  const auto inverse = find_saddle_points(image, {});
  ASSERT_EQ(inverse.size(), 1U);
  EXPECT_TRUE(inverse[0].positive);
}

TEST(SaddlePoints, NoneWhereNoSquaresMeet) {
  EXPECT_TRUE(find_saddle_points(FloatImage({60, 60}, 128), {}).empty());
  const auto edge = [](int x, int y) { return 2 * x + y < 90 ? 50.0F : 200.0F; };
  EXPECT_TRUE(find_saddle_points(drawn(edge), {}).empty()) << "edge";
  const auto corner = [](int x, int y) { return x < 30 && y < 30 ? 50.0F : 200.0F; };
  EXPECT_TRUE(find_saddle_points(drawn(corner), {}).empty()) << "corner";
  const auto branch = [](int x, int y) { return x < 30 ? 125.0F : y < 30 ? 50.0F : 200.0F; };
  EXPECT_TRUE(find_saddle_points(drawn(branch), {}).empty()) << "three areas that meet";
  const auto crossing = [](int x, int y) {
    return std::abs(x - 30) < 2 || std::abs(y - 30) < 2 ? 50.0F : 200.0F;
  };
  EXPECT_TRUE(find_saddle_points(drawn(crossing), {.blur_px = 1}).empty()) << "lines that cross";
}

TEST(SaddlePoints, FaintOnesAreNoise) {
  FloatImage faint = four_squares(0, 90);
  for (float& value : faint.pixels()) value *= 0.03F;
  EXPECT_TRUE(find_saddle_points(faint, {}).empty());
  EXPECT_EQ(find_saddle_points(faint, {.min_deviation = 1}).size(), 1U);
}

TEST(SaddlePoints, ComeInReadingOrder) {
  FloatImage image({200, 200});
  std::mt19937 random(1);
  std::uniform_real_distribution<float> grey(0, 255);
  for (float& value : image.pixels()) value = grey(random);
  const auto saddles = find_saddle_points(image, {});
  ASSERT_GT(saddles.size(), 20U);
  for (std::size_t i = 1; i < saddles.size(); ++i) EXPECT_LE(saddles[i - 1].at.y(), saddles[i].at.y());
}

TEST(GaussianBlur, SpreadsAPointToItsDeviation) {
  FloatImage point({41, 41}, 0);
  point(20, 20) = 1000;
  const FloatImage blurred = gaussian_blur(point, 2);
  double sum = 0;
  Vector2d squares = Vector2d::Zero();
  for (int y = 0; y < 41; ++y) {
    for (int x = 0; x < 41; ++x) {
      const double value = static_cast<double>(blurred(x, y));
      sum += value;
      squares += value * Vector2d((x - 20) * (x - 20), (y - 20) * (y - 20));
    }
  }
  EXPECT_NEAR(sum, 1000, 0.1);
  EXPECT_NEAR(std::sqrt(squares.x() / sum), 2, 0.03);
  EXPECT_NEAR(std::sqrt(squares.y() / sum), 2, 0.03);
}

TEST(GaussianBlur, LeavesAnEvenPictureAloneUpToItsBorder) {
  const FloatImage blurred = gaussian_blur(FloatImage({20, 3}, 77), 4);
  for (const float value : blurred.pixels()) EXPECT_NEAR(value, 77, 1e-3F);
}

}  // namespace
}  // namespace bodyscan
