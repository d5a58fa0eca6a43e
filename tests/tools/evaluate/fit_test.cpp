#include "tools/evaluate/shape_fit.hpp"
#include "tools/evaluate/statistics.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

using Eigen::Vector3d;

TEST(Statistics, OfAKnownSet) {
  std::vector<float> values;
  for (int i = -50; i <= 150; ++i) values.push_back(static_cast<float>(i));  // mean and median 50
  const Statistics result = summarize(values);
  EXPECT_EQ(result.count, 201U);
  EXPECT_NEAR(result.bias, 50, 1e-6);
  EXPECT_NEAR(result.rms, std::sqrt(50 * 50 + (201.0 * 201 - 1) / 12), 1e-3);
  EXPECT_NEAR(result.mad, 50, 1e-6);
  EXPECT_NEAR(result.p50, 50, 1);
  EXPECT_NEAR(result.p95, 140, 1e-3);
  EXPECT_NEAR(result.range_997, 200 * 0.997, 1e-3);
}

TEST(Statistics, OfNothingIsZero) {
  EXPECT_EQ(summarize({}).count, 0U);
  EXPECT_EQ(summarize({}).rms, 0);
}

TEST(Quantile, InterpolatesBetweenNeighbours) {
  std::vector<float> values{4, 1, 3, 2};
  EXPECT_NEAR(quantile(values, 0.5), 2.5, 1e-6);
  EXPECT_NEAR(quantile(values, 0), 1, 1e-6);
  EXPECT_NEAR(quantile(values, 1), 4, 1e-6);
}

TEST(FitPlane, FindsATiltedPlaneAndFacesTheCamera) {
  const Plane expected{Vector3d(0.1, -0.2, -1).normalized(), -900};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> spread(-100, 100);
  std::vector<Vector3d> points;
  for (int i = 0; i < 500; ++i) {
    Vector3d point(spread(random), spread(random), 0);
    point.z() = (expected.offset - expected.normal.dot(point)) / expected.normal.z();
    points.push_back(point);
  }
  const Plane plane = fit_plane(points);
  EXPECT_NEAR((plane.normal - expected.normal).norm(), 0, 1e-9);
  EXPECT_NEAR(plane.offset, expected.offset, 1e-7);
}

TEST(FitSphere, FindsASphereFromACapOfIt) {
  const Sphere expected{Vector3d(40, -30, 1010), 30};
  std::vector<Vector3d> points;
  for (double tilt = 0.05; tilt < 1; tilt += 0.05) {
    for (double turn = 0; turn < 6.2; turn += 0.2) {
      const Vector3d away(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), -std::cos(tilt));
      points.emplace_back(expected.center + expected.radius * away);
    }
  }
  const Sphere sphere = fit_sphere(points);
  EXPECT_NEAR((sphere.center - expected.center).norm(), 0, 1e-7);
  EXPECT_NEAR(sphere.radius, expected.radius, 1e-7);
}

TEST(Regress, SlopeAndIntercept) {
  const std::vector<float> x{0, 1, 2, 3};
  const std::vector<float> y{1, 1.5F, 2, 2.5F};
  EXPECT_NEAR(regress(x, y).slope, 0.5, 1e-6);
  EXPECT_NEAR(regress(x, y).intercept, 1, 1e-6);
  EXPECT_EQ(regress(std::vector<float>{2, 2}, std::vector<float>{1, 3}).slope, 0);
}

}  // namespace
}  // namespace bodyscan
