#include "tools/simulator/sensor.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

struct Moments {
  double mean = 0;
  double variance = 0;
};

// Of the linear light read back from the codes, in electrons.
Moments measure(const Sensor& sensor, float light, double full_well) {
  constexpr int count = 200000;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < count; ++i) {
    const double electrons =
        full_well *
        srgb_to_linear(sensor.expose({light, light, light}, static_cast<std::uint64_t>(i))[1] / 255.0);
    sum += electrons;
    squares += electrons * electrons;
  }
  return {sum / count, squares / count - sum / count * sum / count};
}

TEST(Sensor, NoiseHasTheVarianceOfShotAndReadNoise) {
  // So small a full well that the 8-bit steps are fine against the noise.
  constexpr double full_well = 2000;
  for (const float light : {0.1F, 0.3F, 0.6F}) {
    const Moments moments = measure(Sensor(full_well, 12, 1, 0), light, full_well);
    const double electrons = full_well * static_cast<double>(light);
    EXPECT_NEAR(moments.mean, electrons, 0.003 * electrons + 0.5) << light;
    EXPECT_NEAR(moments.variance / (electrons + 144), 1, 0.03) << light;
  }
}

TEST(Sensor, WithoutNoiseTheCodeIsTheSrgbCurve) {
  const Sensor sensor(0, 12, 1, 0);
  for (int code = 0; code < 256; ++code) {
    const auto light = static_cast<float>(srgb_to_linear(code / 255.0));
    EXPECT_EQ(sensor.expose({light, 0, 1}, 7),
              (std::array<std::uint8_t, 3>{static_cast<std::uint8_t>(code), 0, 255}));
  }
}

TEST(Sensor, LightNeverTurnsNegativeOrOverflows) {
  const Sensor sensor(100, 50, 3, 0);
  int darkest = 255;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const auto codes = sensor.expose({0, 1.5F, 0.01F}, i);
    darkest = std::min<int>(darkest, codes[0]);
  }
  EXPECT_EQ(darkest, 0);
  EXPECT_EQ(Sensor(0, 0, 1, 0).expose({2, 0, 0}, 0)[0], 255);
}

TEST(Sensor, DarknessShowsTheReadNoise) {
  const Sensor sensor(2000, 12, 1, 0);
  int lit = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const auto dark = sensor.expose({0, 0, 0}, i);
    ASSERT_EQ(dark, sensor.expose({1e-12F, 1e-12F, 1e-12F}, i));
    lit += srgb_to_linear(dark[0] / 255.0) * 2000 > 12;
  }
  EXPECT_NEAR(lit / 20000.0, 0.159, 0.02);  // beyond one standard deviation
}

TEST(Sensor, NoiseDependsOnSeedFrameAndPixelOnly) {
  const auto differences = [](const Sensor& a, const Sensor& b) {
    int count = 0;
    for (std::uint64_t i = 0; i < 1000; ++i)
      count += a.expose({0.5F, 0.5F, 0.5F}, i) != b.expose({0.5F, 0.5F, 0.5F}, i);
    return count;
  };
  const Sensor sensor(1000, 12, 5, 2);
  EXPECT_EQ(differences(sensor, Sensor(1000, 12, 5, 2)), 0);
  EXPECT_GT(differences(sensor, Sensor(1000, 12, 6, 2)), 900);
  EXPECT_GT(differences(sensor, Sensor(1000, 12, 5, 3)), 900);
}

TEST(Sensor, PixelsFramesAndChannelsAreUncorrelated) {
  constexpr int count = 50000;
  const Sensor sensor(2000, 12, 1, 0);
  const Sensor next(2000, 12, 1, 1);
  double neighbour = 0;
  double frame = 0;
  double channel = 0;
  double power = 0;
  const auto noise = [](std::uint8_t code) { return srgb_to_linear(code / 255.0) - 0.4; };
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto here = sensor.expose({0.4F, 0.4F, 0.4F}, i);
    neighbour += noise(here[0]) * noise(sensor.expose({0.4F, 0.4F, 0.4F}, i + 1)[0]);
    frame += noise(here[0]) * noise(next.expose({0.4F, 0.4F, 0.4F}, i)[0]);
    channel += noise(here[0]) * noise(here[2]);
    power += noise(here[0]) * noise(here[0]);
  }
  for (const double correlation : {neighbour / power, frame / power, channel / power})
    EXPECT_LT(std::abs(correlation), 0.02);
}

}  // namespace
}  // namespace bodyscan::simulator
