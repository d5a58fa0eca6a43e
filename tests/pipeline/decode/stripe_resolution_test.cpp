#include "pipeline/decode/stripe_resolution.hpp"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr Size camera{256, 96};
constexpr int contrast = 8000;
constexpr NoiseModel no_noise{1, 0};

using Amplitudes = std::array<double, StripePlanes::fine_bits>;  // of the contrast, bits 0, 1, 2

// The left and the right half of the picture differ in what is left of the finest bits.
StripePlanes planes_of(const Amplitudes& left, const Amplitudes& right, int bit_count = 10) {
  StripePlanes planes(camera, bit_count);
  for (std::size_t bit = 0; bit < left.size(); ++bit) {
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const double amplitude = (x < camera.width / 2 ? left : right)[bit] * contrast;
        planes.fine[bit](x, y) = static_cast<std::int16_t>((y >> bit) & 1 ? amplitude : -amplitude);
      }
    }
  }
  return planes;
}

StripeResolution resolve(const StripePlanes& planes, const Image<std::uint16_t>& light, int max_dropped,
                         const NoiseModel& noise) {
  StripeEnergy energy(light, noise);
  for (int bit = StripePlanes::fine_bits; bit-- > 0;)
    energy.add(bit, planes.fine[static_cast<std::size_t>(bit)], light);
  return energy.resolve(planes.bit_count, max_dropped);
}

StripeResolution resolve(const StripePlanes& planes, int max_dropped = 2,
                         const NoiseModel& noise = no_noise) {
  return resolve(planes, Image<std::uint16_t>(camera, contrast), max_dropped, noise);
}

constexpr int at_left = 40;
constexpr int at_right = 216;
constexpr int middle = 48;

TEST(StripeResolution, KeepsEverythingThatIsSharp) {
  const auto resolution = resolve(planes_of({0.6, 0.8, 0.9}, {0.6, 0.8, 0.9}));
  for (const std::uint8_t dropped : resolution.dropped.pixels()) EXPECT_EQ(dropped, 0);
}

TEST(StripeResolution, DropsWhatVanishesAndOnlyThere) {
  const auto one = resolve(planes_of({0.6, 0.8, 0.9}, {0.05, 0.5, 0.8}));
  EXPECT_EQ(one.at(at_left, middle), 0);
  EXPECT_EQ(one.at(at_right, middle), 1);
  const auto two = resolve(planes_of({0.05, 0.5, 0.8}, {0.0, 0.1, 0.6}));
  EXPECT_EQ(two.at(at_left, middle), 1);
  EXPECT_EQ(two.at(at_right, middle), 2);
}

TEST(StripeResolution, DropsNoMoreThanAllowed) {
  const auto planes = planes_of({0, 0, 0.5}, {0, 0, 0.5});
  for (const int allowed : {0, 1, 2}) EXPECT_EQ(resolve(planes, allowed).at(at_left, middle), allowed);
}

TEST(StripeResolution, KeepsTwoBitsOfAShortCode) {
  for (const int bits : {1, 2, 3, 4}) {
    const auto resolution = resolve(planes_of({0, 0, 0}, {0, 0, 0}, bits));
    EXPECT_EQ(resolution.at(at_left, middle), std::max(0, bits - 2)) << bits;
  }
}

TEST(StripeResolution, NoiseIsNoStripe) {
  auto planes = planes_of({0, 0.5, 0.6}, {0.3, 0.5, 0.6});
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 0.2 * contrast);
  for (auto& plane : planes.fine)
    for (auto& value : plane.pixels()) value = static_cast<std::int16_t>(value + normal(random));
  const NoiseModel noise{static_cast<float>(std::pow(0.2 * contrast, 2)), 0};
  EXPECT_EQ(resolve(planes, 2, noise).at(at_left, middle), 1);
  EXPECT_EQ(resolve(planes, 2, noise).at(at_right, middle), 0);
  EXPECT_EQ(resolve(planes, 2, no_noise).at(at_left, middle), 0);  // as much energy as stripes would have
}

TEST(StripeResolution, UnlitPixelsHaveNoSay) {
  // In every other column the fine bit is strong but nothing is lit.
  auto planes = planes_of({0.02, 0.5, 0.8}, {0.02, 0.5, 0.8});
  Image<std::uint16_t> light(camera, contrast);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; x += 2) {
      light(x, y) = 0;
      planes.fine[0](x, y) = contrast;
    }
  }
  EXPECT_EQ(resolve(planes, light, 2, no_noise).at(at_left, middle), 1);
}

}  // namespace
}  // namespace bodyscan
