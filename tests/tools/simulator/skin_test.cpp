#include "tools/simulator/skin.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

TEST(Skin, HasTheMeanAlbedoAndSomeMottling) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squares = 0;
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d point(0.37 * i, 0.11 * i, -0.23 * i);
    const Eigen::Vector3d albedo = skin_albedo(point, {}).cast<double>();
    sum += albedo;
    squares += albedo.y() * albedo.y();
  }
  const Eigen::Vector3d mean = sum / count;
  EXPECT_LT((mean - Eigen::Vector3d(0.72, 0.48, 0.38)).cwiseAbs().maxCoeff(), 0.01);
  const double spread = std::sqrt(squares / count - mean.y() * mean.y()) / mean.y();
  EXPECT_GT(spread, 0.01);
  EXPECT_LT(spread, 0.08);
}

TEST(Skin, AMoleIsDarkUpToItsRadius) {
  const std::vector<MoleFact> moles{{Eigen::Vector3d(10, 20, 30), 4}};
  const auto red = [&](double distance) { return skin_albedo({10 + distance, 20, 30}, moles).x(); };
  EXPECT_NEAR(red(0), 0.26, 1e-5);
  EXPECT_NEAR(red(1.8), 0.26, 1e-5);
  EXPECT_GT(red(2.2), 0.6);
  EXPECT_NEAR(red(2.0), (0.26 + 0.72) / 2, 0.05);
}

TEST(Skin, NoiseIsContinuousAndWithinItsRange) {
  for (double x = -3; x < 3; x += 0.01) {
    const double here = smooth_noise({x, 0.3, -0.7});
    EXPECT_LE(std::abs(here), 1);
    EXPECT_LT(std::abs(smooth_noise({x + 1e-4, 0.3, -0.7}) - here), 1e-3);
  }
}

}  // namespace
}  // namespace bodyscan::simulator
