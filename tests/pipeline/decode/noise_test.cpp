#include "pipeline/decode/noise.hpp"

#include "pipeline/decode/illumination.hpp"
#include "pipeline/decode/response.hpp"
#include "tests/pipeline/decode/synthetic_capture.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

struct Measured {
  StripePlanes planes;
  Illumination light;
};

Measured measure(const Scene& scene, const CaptureOptions& options) {
  const auto frames = capture(scene, options);
  const auto linear = linear_table(options.response, options.bits);
  Measured result{StripePlanes(options.camera, gray_bits(options.projector.height)),
                  *measure_illumination(frames[0].luma, frames[1].luma, 5, linear)};
  for (std::size_t i = 2; i < frames.size(); i += 2)
    result.planes.add(frames[i].pattern.bit, frames[i].luma, frames[i + 1].luma, linear);
  return result;
}

// A plane in four shades.
Scene shaded(const CaptureOptions& options) {
  return [plane = plane_scene(options, 30)](int x, int y) {
    Sight sight = plane(x, y);
    sight.albedo = 0.15 + 0.2 * (x / 64 % 4);
    return sight;
  };
}

struct Noise {
  double read;
  double shot;
  ToneResponse::Kind response;
};

class NoiseLevel : public testing::TestWithParam<Noise> {};

TEST_P(NoiseLevel, IsFoundInTheCapture) {
  const Noise& noise = GetParam();
  CaptureOptions options{.camera = {384, 256}, .response = {noise.response, 1}, .bits = 16};
  options.read_noise = noise.read;
  options.shot_noise = noise.shot;
  const Measured capture = measure(shaded(options), options);
  const NoiseModel model = measure_noise(capture.planes, capture.light.contrast);
  for (const double albedo : {0.15, 0.35, 0.55, 0.75}) {
    // Pattern and inverse, one of them lit.
    const double variance = 2 * noise.read * noise.read + noise.shot * (albedo + 2 * options.ambient);
    const double found =
        std::sqrt(model.variance(static_cast<float>(albedo * linear_full_scale))) / linear_full_scale;
    EXPECT_NEAR(found / std::sqrt(variance), 1, 0.2) << albedo;
  }
}

INSTANTIATE_TEST_SUITE_P(Noise, NoiseLevel,
                         testing::Values(Noise{0.002, 0, ToneResponse::Kind::linear},
                                         Noise{0.01, 0, ToneResponse::Kind::srgb},
                                         Noise{0.001, 1e-4, ToneResponse::Kind::linear},
                                         Noise{0.002, 5e-4, ToneResponse::Kind::srgb}));

TEST(NoiseModel, ScatteredLightThatVariesSlowlyIsNoNoise) {
  CaptureOptions options{.camera = {384, 256}, .bits = 16, .read_noise = 0.002};
  const Scene scene = [plane = plane_scene(options, 30)](int x, int y) {
    Sight sight = plane(x, y);
    sight.scattered = 0.05 + 0.0005 * x;
    sight.scattered_row = 300 + 0.3 * x;
    return sight;
  };
  const Measured capture = measure(scene, options);
  const NoiseModel model = measure_noise(capture.planes, capture.light.contrast);
  const double found = std::sqrt(model.variance(0.7F * linear_full_scale)) / linear_full_scale;
  EXPECT_NEAR(found / (0.002 * std::sqrt(2)), 1, 0.2);
}

TEST(NoiseModel, TooFewBitsToMeasureGiveOneGreyLevel) {
  const CaptureOptions options{.projector = {64, 12}};
  const Measured capture = measure(plane_scene(options, 0, 20), options);
  const NoiseModel model = measure_noise(capture.planes, capture.light.contrast);
  EXPECT_EQ(model.slope, 0);
  const double grey_level = linear_full_scale / 255.0;
  EXPECT_GT(std::sqrt(model.constant), grey_level);
  EXPECT_LT(std::sqrt(model.constant), 3 * grey_level);
}

}  // namespace
}  // namespace bodyscan
