#include "pipeline/decode/local_fit.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr Size camera{120, 90};

using Surface = std::function<double(int x, int y)>;

constexpr LocalFitOptions fit{.half_width_px = 1, .max_half_width_px = 3, .enough_sigma_px = 0.01F};

// 2.9 camera px a projector px.
double plane(int x, int y) {
  return 20 + 0.35 * y + 0.05 * x;
}

AxisCorrespondence measured(const Surface& surface, float sigma, double noise = 0, unsigned seed = 7) {
  AxisCorrespondence axis{FloatImage(camera), FloatImage(camera, sigma)};
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      axis.coordinate(x, y) = static_cast<float>(surface(x, y) + noise * normal(random));
  return axis;
}

CoordinateRows rows_of(const AxisCorrespondence& axis) {
  return [&](const RowRange& rows, const RowArrays& arrays) {
    for (int i = 0; i < rows.count; ++i) {
      const int y = rows.camera_row(i);
      std::copy_n(axis.coordinate.row(y), axis.coordinate.width(), arrays.coordinate_row(i));
      std::copy_n(axis.sigma.row(y), axis.sigma.width(), arrays.sigma_row(i));
    }
  };
}

AxisCorrespondence fit_locally(const AxisCorrespondence& raw, const LocalFitOptions& options,
                               float px_per_unit = 1 / 0.35F) {
  AxisCorrespondence fitted{FloatImage(raw.coordinate.size()), FloatImage(raw.sigma.size())};
  fit_locally(rows_of(raw), px_per_unit, options, fitted);
  return fitted;
}

double rms(const AxisCorrespondence& axis, const Surface& surface, int margin) {
  double squares = 0;
  int count = 0;
  for (int y = margin; y < camera.height - margin; ++y) {
    for (int x = margin; x < camera.width - margin; ++x, ++count)
      squares += std::pow(axis.coordinate(x, y) - surface(x, y), 2);
  }
  return std::sqrt(squares / count);
}

double mean_sigma(const AxisCorrespondence& axis, int margin) {
  double squares = 0;
  int count = 0;
  for (int y = margin; y < camera.height - margin; ++y)
    for (int x = margin; x < camera.width - margin; ++x, ++count) squares += std::pow(axis.sigma(x, y), 2);
  return std::sqrt(squares / count);
}

double worst(const AxisCorrespondence& axis, const Surface& surface) {
  double result = 0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      result = std::max(result, std::abs(axis.coordinate(x, y) - surface(x, y)));
  return result;
}

TEST(LocalFit, KeepsPlanesAndCurvature) {
  const Surface bowl = [](int x, int y) {
    const double dx = x - 60;
    const double dy = y - 45;
    return plane(x, y) + 0.003 * dx * dx - 0.002 * dy * dy + 0.001 * dx * dy;
  };
  const auto fitted = fit_locally(measured(bowl, 0.005F), fit);
  EXPECT_LT(worst(fitted, bowl), 5e-5);
}

// Savitzky and Golay 1964: the middle weight of a quadratic over 7 points is 7 / 21, over 13 points 25 / 143.
struct Gain {
  float sigma;
  float gain;
};

class NoiseGain : public testing::TestWithParam<Gain> {};

TEST_P(NoiseGain, IsWhatSigmaSays) {
  const auto [sigma, gain] = GetParam();
  const auto fitted = fit_locally(measured(plane, sigma, sigma), fit);
  EXPECT_NEAR(fitted.sigma(60, 45), gain * sigma, 1e-3 * sigma);
  EXPECT_NEAR(rms(fitted, plane, 12) / mean_sigma(fitted, 12), 1, 0.15);
  EXPECT_LT(mean_sigma(fitted, 12), 1.6 * gain * sigma);
}

// One projector pixel's half width is 3 camera px here; a square grows until sigma is at most 0.01 px.
INSTANTIATE_TEST_SUITE_P(LocalFit, NoiseGain,
                         testing::Values(Gain{0.005F, 7 / 21.0F}, Gain{0.05F, 25 / 143.0F}));

TEST(LocalFit, OffLeavesEverythingAlone) {
  LocalFitOptions options;
  options.half_width_px = 0;
  const auto raw = measured(plane, 0.02F, 0.02);
  const auto fitted = fit_locally(measured(plane, 0.02F, 0.02), options);
  for (std::size_t i = 0; i < camera.area(); ++i) {
    ASSERT_EQ(fitted.coordinate.data()[i], raw.coordinate.data()[i]);
    ASSERT_EQ(fitted.sigma.data()[i], raw.sigma.data()[i]);
  }
}

TEST(LocalFit, DoesNotReachAcrossAJump) {
  for (const bool upright : {true, false}) {
    const Surface step = [=](int x, int y) {
      return plane(x, y) + ((upright ? x >= 50 : y >= 50) ? 3.7 : 0);
    };
    const auto fitted = fit_locally(measured(step, 0.05F), fit);
    EXPECT_LT(worst(fitted, step), 5e-5);
    // Far from the jump it still fits; a pixel at the jump bends and stands alone.
    EXPECT_LT(fitted.sigma(20, 20), 0.01F);
    EXPECT_FLOAT_EQ(upright ? fitted.sigma(50, 20) : fitted.sigma(20, 50), 0.05F);
  }
}

TEST(LocalFit, FillsNoHolesAndFitsBesideThem) {
  auto raw = measured(plane, 0.05F);
  raw.coordinate(60, 45) = nan;
  const auto fitted = fit_locally(raw, fit);
  EXPECT_TRUE(std::isnan(fitted.coordinate(60, 45)));
  int undecided = 0;
  for (const float value : fitted.coordinate.pixels()) undecided += std::isnan(value);
  EXPECT_EQ(undecided, 1);
  // As good as a whole square of the largest radius for weighted fits, but for the one value: 17 x 17 points.
  EXPECT_LT(fitted.sigma(61, 45), 0.01F);
  EXPECT_NEAR(fitted.sigma(80, 45), 25 / 143.0 * 0.05, 1e-4);
}

// A surface that ends: what is left of the square on this side still tells where its last pixels lie.
TEST(LocalFit, FitsTheRimFromInside) {
  double squares = 0;
  double variances = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    auto raw = measured(plane, 0.05F, 0.05, seed);
    for (int y = 0; y < camera.height; ++y)
      for (int x = 60; x < camera.width; ++x) raw.coordinate(x, y) = nan;
    const auto fitted = fit_locally(raw, fit);
    for (int y = 15; y < 75; ++y) {
      EXPECT_TRUE(std::isnan(fitted.coordinate(60, y)));
      squares += std::pow(fitted.coordinate(59, y) - plane(59, y), 2);
      variances += std::pow(fitted.sigma(59, y), 2);
    }
  }
  EXPECT_LT(std::sqrt(variances / (20 * 60)), 0.6 * 0.05);
  EXPECT_NEAR(std::sqrt(squares / variances), 1, 0.15);
}

TEST(LocalFit, FitsThePicturesBorderToo) {
  const auto fitted = fit_locally(measured(plane, 0.05F), fit);
  EXPECT_LT(fitted.sigma(0, 45), 0.5F * 0.05F);
  EXPECT_LT(fitted.sigma(camera.width - 1, camera.height - 1), 0.9F * 0.05F);
  EXPECT_LT(worst(fitted, plane), 5e-5);
}

TEST(LocalFit, GivesCertainValuesMoreWeightWhereItIsNoisy) {
  // Every other row is four times as certain, and both are too noisy for whole squares to do.
  double mean_rms = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    AxisCorrespondence raw = measured(plane, 0.4F);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        if (y % 2 == 0) raw.sigma(x, y) = 0.1F;
        raw.coordinate(x, y) += static_cast<float>(static_cast<double>(raw.sigma(x, y)) * normal(random));
      }
    }
    mean_rms += rms(fit_locally(raw, fit), plane, 12) / 20;
  }
  // Radius 8 without weights: 43 / 323 of the root mean square of sigma, 0.29.
  EXPECT_LT(mean_rms, 0.75 * 43 / 323 * 0.29);
}

TEST(LocalFit, GrowsOnlyWhereNoiseDemands) {
  auto raw = measured(plane, 0.005F);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 60; x < camera.width; ++x) raw.sigma(x, y) = 0.05F;
  const auto fitted = fit_locally(raw, fit);
  EXPECT_NEAR(fitted.sigma(20, 45), 7 / 21.0 * 0.005, 1e-5);
  EXPECT_NEAR(fitted.sigma(100, 45), 25 / 143.0 * 0.05, 1e-4);
}

TEST(LocalFit, APictureSmallerThanTheSquareIsFittedByWhatItHolds) {
  AxisCorrespondence tiny{FloatImage({4, 4}), FloatImage({4, 4}, 0.1F)};
  for (int i = 0; i < 16; ++i)
    tiny.coordinate.data()[i] = static_cast<float>(i % 4) + 0.1F * static_cast<float>(i);
  const auto fitted = fit_locally(tiny, fit);
  for (int i = 0; i < 16; ++i) EXPECT_NEAR(fitted.coordinate.data()[i], tiny.coordinate.data()[i], 1e-4);
}

TEST(LocalFit, AnUnknownScaleLeavesEverythingAlone) {
  const auto raw = measured(plane, 0.02F, 0.02);
  const auto fitted = fit_locally(raw, fit, 0);
  for (std::size_t i = 0; i < camera.area(); ++i)
    ASSERT_EQ(fitted.coordinate.data()[i], raw.coordinate.data()[i]);
}

}  // namespace
}  // namespace bodyscan
