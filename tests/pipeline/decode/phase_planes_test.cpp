#include "pipeline/decode/phase_planes.hpp"

#include "pipeline/decode/middle_light.hpp"
#include "pipeline/decode/response.hpp"
#include "pipeline/decode/stripe_amplitude.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr Size camera{64, 48};
const std::vector<std::uint16_t> linear = linear_table({ToneResponse::Kind::linear, 1}, 16);

// Steps of a cosine of this amplitude and phase at every pixel, shares of full scale.
PhasePlanes planes_of(const PhaseCode& code, double amplitude, double phase, double noise = 0) {
  PhasePlanes planes(camera, code);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int step = 0; step < code.steps; ++step) {
    GrayImage16 picture(camera);
    for (auto& pixel : picture.pixels())
      pixel = static_cast<std::uint16_t>(
          std::lround(65535 * (0.3 + amplitude * std::cos(phase - 2 * std::numbers::pi * step / code.steps) +
                               noise * normal(random))));
    planes.add(step, Luma(std::move(picture)), linear);
  }
  return planes;
}

TEST(PhasePlanes, HoldTheCosinesAmplitudeAndPhase) {
  for (const int steps : {3, 4, 5, 8, 16}) {
    for (double phase = -3; phase < 3.1; phase += 0.7) {
      const PhasePlanes planes = planes_of({.period_px = 16 * steps, .steps = steps}, 0.2, phase);
      const double c = planes.cosine()(5, 7);
      const double s = planes.sine()(5, 7);
      EXPECT_NEAR(std::hypot(c, s), 0.2 * linear_full_scale, 3);
      EXPECT_NEAR(std::remainder(std::atan2(s, c) - phase, 2 * std::numbers::pi), 0, 2e-3);
    }
  }
}

TEST(PhasePlanes, ABrightPictureDoesNotOverflow) {
  for (const int steps : {3, 5, 16}) {
    const PhaseCode code{.period_px = steps, .steps = steps};
    PhasePlanes planes(camera, code);
    // Lit wherever the cosine is positive: the largest sum there is; a cosine of 0 does not matter to it.
    for (int step = 0; step < steps; ++step) {
      const bool lit = std::cos(2 * std::numbers::pi * step / steps) > 1e-9;
      planes.add(step, Luma(GrayImage16(camera, static_cast<std::uint16_t>(lit ? 65535 : 0))), linear);
    }
    EXPECT_GT(planes.cosine()(0, 0), 0.6 * linear_full_scale);
    EXPECT_NEAR(planes.sine()(0, 0), 0, steps);
  }
}

TEST(StripeAmplitude, IsTheShareOfContrastWithoutTheNoise) {
  constexpr double noise = 0.02;
  const PhasePlanes planes = planes_of({}, 0.05, 1, noise);
  const Image<std::uint16_t> contrast(camera, linear_full_scale / 2);
  const StripeAmplitude amplitude(planes, contrast);
  const float variance = static_cast<float>(std::pow(noise * linear_full_scale, 2));
  std::vector<float> squares(static_cast<std::size_t>(camera.width));
  amplitude.squares_of_row(20, {variance, 0}, camera.width, squares.data());
  EXPECT_NEAR(squares[0], 0.01, 0.001);
  EXPECT_NEAR(squares.back(), 0.01, 0.001);
  amplitude.squares_of_row(20, {4 * variance, 0}, camera.width, squares.data());
  EXPECT_LT(squares[0], 0.009);
}

TEST(StripeAmplitude, UnlitPixelsDoNotCount) {
  const PhasePlanes planes = planes_of({}, 0.2, 1);
  Image<std::uint16_t> contrast(camera, linear_full_scale / 2);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < 20; ++x) contrast(x, y) = 0;
  std::vector<float> squares(static_cast<std::size_t>(camera.width));
  StripeAmplitude(planes, contrast).squares_of_row(3, {}, camera.width, squares.data());
  EXPECT_NEAR(squares[0], 0.16, 0.001);
  EXPECT_NEAR(squares[63], 0.16, 0.001);
}

TEST(MiddleLight, TheStepsMeanTakesNoiseOff) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const auto picture = [&](double light) {
    GrayImage16 image(camera);
    for (auto& pixel : image.pixels())
      pixel = static_cast<std::uint16_t>(std::lround(65535 * (light + 0.02 * normal(random))));
    return Luma(std::move(image));
  };
  const double white = 0.6;
  const double black = 0.1;
  const Luma lit = picture(white);
  const Luma dark = picture(black);
  MiddleLight middle(lit, dark, linear);
  Image<std::uint16_t> contrast(camera);
  for (std::size_t i = 0; i < camera.area(); ++i)
    contrast.data()[i] = static_cast<std::uint16_t>(linear[std::get<GrayImage16>(lit).data()[i]] -
                                                    linear[std::get<GrayImage16>(dark).data()[i]]);
  const auto deviation = [&] {
    double squares = 0;
    for (const auto sum : middle.twice().pixels())
      squares += std::pow(static_cast<double>(sum) / linear_full_scale - white - black, 2);
    return std::sqrt(squares / static_cast<double>(camera.area())) / 0.02;
  };
  EXPECT_NEAR(deviation(), std::sqrt(2), 0.05);
  EXPECT_FLOAT_EQ(middle.variance(), 2);

  const PhaseCode code;
  PhasePlanes steps(camera, code);
  for (int step = 0; step < code.steps; ++step) {
    // Two of five rows are lit at a time.
    const double light = step < 2 ? white : black;
    steps.add(step, picture(light), linear);
  }
  middle.refine(steps, contrast);
  EXPECT_NEAR(middle.variance(), 0.611, 0.001);
  EXPECT_NEAR(deviation(), std::sqrt(0.611), 0.05);
}

}  // namespace
}  // namespace bodyscan
