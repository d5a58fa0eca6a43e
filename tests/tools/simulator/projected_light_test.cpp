#include "tools/simulator/projected_light.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

constexpr Size projector{1024, 768};

double edge(double distance, double sigma) {
  return 0.5 * (1 + std::erf(distance / (sigma * std::sqrt(2.0))));
}

TEST(ProjectedLight, WhiteIsOneAndBlackZeroBeyondThePictureToo) {
  const ProjectedLight white({.kind = PatternKind::white}, projector, 0.55, 2.46);
  const ProjectedLight black({.kind = PatternKind::black}, projector, 0.55, 2.46);
  for (const float at : {-0.5F, 0.0F, 383.7F, 767.0F, 767.5F}) {
    EXPECT_NEAR(white.at(at).focused, 1, 1e-6);
    EXPECT_NEAR(white.at(at).scatter_change, 0, 1e-6);
    EXPECT_EQ(black.at(at).focused, 0);
  }
  EXPECT_NEAR(white.mean(), 1, 1e-5);
  EXPECT_EQ(black.mean(), 0);
}

TEST(ProjectedLight, AnEdgeIsTheGaussiansIntegralBetweenThePixels) {
  // The coarsest of 768 rows' bits turns white between rows 511 and 512.
  const double defocus = 0.55;
  const double scattered = 2.46;
  const ProjectedLight light({PatternKind::gray, Axis::row, 9, false}, projector, defocus, scattered);
  for (double distance = -6; distance <= 6; distance += 0.037) {
    const ProjectedLight::Value value = light.at(static_cast<float>(511.5 + distance));
    EXPECT_NEAR(value.focused, edge(distance, defocus), 2e-4) << distance;
    EXPECT_NEAR(value.focused + value.scatter_change, edge(distance, scattered), 2e-4) << distance;
  }
  EXPECT_NEAR(light.mean(), 256.0 / 768, 1e-5);
}

TEST(ProjectedLight, WithoutBlurTheRowsAreBoxes) {
  const Pattern pattern{PatternKind::gray, Axis::column, 0, false};
  const ProjectedLight light(pattern, projector, 0, 0);
  EXPECT_EQ(light.axis(), Axis::column);
  for (unsigned i = 0; i < 1024; ++i) {
    const float wanted = pattern_is_white(pattern, i) ? 1 : 0;
    for (const float offset : {-0.45F, 0.0F, 0.45F})
      EXPECT_EQ(light.at(static_cast<float>(i) + offset).focused, wanted);
  }
}

TEST(ProjectedLight, APatternAndItsInverseAddUpToWhite) {
  const ProjectedLight light({PatternKind::gray, Axis::row, 2, false}, projector, 0.8, 2.5);
  const ProjectedLight inverse({PatternKind::gray, Axis::row, 2, true}, projector, 0.8, 2.5);
  for (float at = -0.5F; at < 767.5F; at += 0.77F)
    EXPECT_NEAR(light.at(at).focused + inverse.at(at).focused, 1, 1e-5) << at;
}

TEST(ProjectedLight, PhaseStepsAddUpToTheLitShareOfWhite) {
  const PhaseCode code;
  std::vector<ProjectedLight> steps;
  for (int step = 0; step < code.steps; ++step)
    steps.emplace_back(Pattern{.kind = PatternKind::phase,
                               .axis = Axis::column,
                               .period_px = code.period_px,
                               .step = step,
                               .steps = code.steps},
                       projector, 0.55, 2.46);
  EXPECT_EQ(steps[0].axis(), Axis::column);
  for (float at = 10; at < 1014; at += 0.77F) {
    float sum = 0;
    for (const ProjectedLight& light : steps) sum += light.at(at).focused;
    EXPECT_NEAR(sum, 2, 1e-5) << at;
  }
  EXPECT_NEAR(steps[3].mean(), 0.4, 2e-3);
}

TEST(ProjectedLight, BlurTakesTheFinestStripesContrastByTheGaussiansTransferFunction) {
  // The finest stripes have a period of 4 rows; a square wave's first harmonic swings by 4 / pi.
  const double sigma = 1.6;
  const ProjectedLight light({PatternKind::gray, Axis::row, 0, false}, projector, sigma, sigma);
  const double contrast =
      static_cast<double>(light.at(381.5F).focused) - static_cast<double>(light.at(383.5F).focused);
  const double transfer = std::exp(-2 * std::pow(3.14159265 * sigma / 4, 2));
  EXPECT_NEAR(std::abs(contrast), 4 / 3.14159265 * transfer, 2e-3);
}

}  // namespace
}  // namespace bodyscan::simulator
