#include "tests/accuracy/simulated_scan.hpp"
#include "tests/accuracy/thresholds.hpp"
#include "tools/bench/scenes.hpp"

#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr double quarter = 0.25;

class Accuracy : public testing::TestWithParam<Thresholds> {};

void expect_at_most(const char* figure, double value, const std::optional<double>& limit) {
  if (limit) {
    EXPECT_LE(std::abs(value), *limit) << figure;
  }
}

void expect_at_least(const char* figure, double value, const std::optional<double>& limit) {
  if (limit) {
    EXPECT_GE(value, *limit) << figure;
  }
}

void check_shapes(const Evaluation& result, const Thresholds& limit) {
  EXPECT_EQ(result.steps.size(), limit.step ? 4U : 0U);
  EXPECT_EQ(result.spheres.size(), limit.sphere_diameter ? 2U : 0U);
  EXPECT_EQ(result.moles.empty(), !limit.mole_contrast);
  expect_at_most("step", result.worst_step_mm(), limit.step);
  expect_at_most("sphere spacing", result.sphere_spacing_error_mm, limit.sphere_spacing);
  expect_at_most("sphere diameter", result.worst_diameter_mm(), limit.sphere_diameter);
  expect_at_most("sphere form", result.worst_form_mm(), limit.sphere_form);
  expect_at_most("flatness", result.worst_flatness_mm(), limit.flatness);
  expect_at_least("3 mm bump", result.bump_kept(3, 0.5), limit.bump_3mm_kept);
  expect_at_least("5 mm bump", result.bump_kept(5, 0.5), limit.bump_5mm_kept);
  expect_at_least("mole contrast", result.median_mole_contrast(), limit.mole_contrast);
  expect_at_least("mole coverage", result.least_mole_coverage(), limit.mole_coverage);
}

TEST_P(Accuracy, OfASimulatedScene) {
  const Thresholds& limit = GetParam();
  const Expected<Evaluation> result = scan_simulated(bench_scene(limit.scene, quarter).value().options);
  ASSERT_TRUE(result) << result.error().message;
  std::cout << to_table(*result);
  EXPECT_LE(result->deviation.rms, limit.rms);
  EXPECT_LE(result->share_wrong, limit.share_wrong);
  EXPECT_GE(result->coverage.completeness(), limit.completeness);
  check_shapes(*result, limit);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Accuracy, testing::ValuesIn(thresholds()),
                         [](const auto& instance) { return instance.param.scene; });

}  // namespace
}  // namespace bodyscan
