#include "tools/simulator/lens_blur.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

LightImage dark(Size size) {
  return LightImage(size, {0, 0, 0});
}

TEST(LensBlur, APointBecomesAGaussianOfTheAskedWidthAndTheSameLight) {
  for (const double sigma : {0.7, 1.5, 4.0}) {
    LightImage image = dark({71, 61});
    image(35, 30) = {2, 0, 0};
    image(30, 28) = {0, 0.5F, 0};
    blur_light(image, sigma);
    std::array<double, 3> sum{};
    double across = 0;
    double down = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        for (unsigned c = 0; c < 3; ++c) sum[c] += static_cast<double>(image(x, y)[c]);
        across += static_cast<double>(image(x, y)[0]) / 2 * (x - 35) * (x - 35);
        down += static_cast<double>(image(x, y)[0]) / 2 * (y - 30) * (y - 30);
      }
    }
    EXPECT_NEAR(sum[0], 2, 1e-5);
    EXPECT_NEAR(sum[1], 0.5, 1e-5);
    EXPECT_EQ(sum[2], 0);
    EXPECT_NEAR(std::sqrt(across), sigma, 0.003 * sigma);
    EXPECT_NEAR(std::sqrt(down), sigma, 0.003 * sigma);
    const double falloff = static_cast<double>(image(35 + 2, 30 - 1)[0] / image(35, 30)[0]);
    EXPECT_NEAR(falloff, std::exp(-5 / (2 * sigma * sigma)), 1e-5);
  }
}

TEST(LensBlur, LightSpreadsAsFarAsItsReach) {
  EXPECT_EQ(lens_blur_reach(0), 0);
  EXPECT_EQ(lens_blur_reach(0.7), 3);
  EXPECT_EQ(lens_blur_reach(2), 8);
  LightImage image = dark({31, 31});
  image(15, 15) = {1, 1, 1};
  blur_light(image, 2);
  EXPECT_GT(image(15 + 8, 15)[1], 0);
  EXPECT_EQ(image(15 + 9, 15)[1], 0);
  EXPECT_GT(image(15, 15 - 8)[1], 0);
  EXPECT_EQ(image(15, 15 - 9)[1], 0);
}

TEST(LensBlur, BeyondItsEdgeThePictureGoesOn) {
  constexpr Size size{13, 11};
  constexpr int margin = 12;
  LightImage image(size);
  LightImage larger({size.width + 2 * margin, size.height + 2 * margin});
  const auto value = [](int x, int y) {
    const auto ramp = static_cast<float>(x * x + 3 * y);
    return std::array{ramp, 100 - ramp, static_cast<float>(x * y)};
  };
  for (int y = 0; y < larger.height(); ++y) {
    for (int x = 0; x < larger.width(); ++x)
      larger(x, y) =
          value(std::clamp(x - margin, 0, size.width - 1), std::clamp(y - margin, 0, size.height - 1));
  }
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) image(x, y) = value(x, y);
  }
  blur_light(image, 2.5);
  blur_light(larger, 2.5);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      for (unsigned c = 0; c < 3; ++c) ASSERT_NEAR(image(x, y)[c], larger(x + margin, y + margin)[c], 1e-3);
    }
  }
}

TEST(LensBlur, APictureSmallerThanTheBlurKeepsItsEvenLight) {
  LightImage image({3, 2}, {0.25F, 0.5F, 1});
  blur_light(image, 20);
  for (const auto& pixel : image.pixels()) {
    EXPECT_NEAR(pixel[0], 0.25, 1e-5);
    EXPECT_NEAR(pixel[1], 0.5, 1e-5);
    EXPECT_NEAR(pixel[2], 1, 1e-5);
  }
}

}  // namespace
}  // namespace bodyscan::simulator
