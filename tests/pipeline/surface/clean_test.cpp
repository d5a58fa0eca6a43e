#include "pipeline/surface/clean.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "tests/pipeline/surface/scenes.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

std::size_t count(const Image<PointState>& states, PointState state) {
  return static_cast<std::size_t>(std::ranges::count(states.pixels(), state));
}

TEST(FindArtifacts, KeepsAnInclinedNoisyPlane) {
  const Lens lens = scenes::camera();
  for (const double degrees : {0.0, 45.0, 60.0, 75.0}) {
    scenes::Noise noise(0.05);
    const double slope = std::tan(degrees * std::numbers::pi / 180);
    const PointGrid grid = scenes::grid(
        lens, [&](int x, int) { return scenes::inclined_plane(lens, x, 1050, slope) + noise(); }, 0.05F);
    CleanReport report;
    const Image<PointState> states = find_artifacts(grid, lens, {}, report);
    EXPECT_EQ(report.points, lens.size.area());
    EXPECT_EQ(count(states, PointState::kept), lens.size.area()) << degrees << " degrees";
  }
}

TEST(FindArtifacts, RemovesIsolatedPoints) {
  const Lens lens = scenes::camera();
  PointGrid grid = scenes::grid(lens, [&](int x, int) { return x < 100 ? 1000.0 : double{scenes::none}; });
  for (const int x : {120, 140, 141, 199}) grid.points(x, 70) = scenes::point_at(lens, x, 70, 1000);
  CleanReport report;
  const Image<PointState> states = find_artifacts(grid, lens, {}, report);
  EXPECT_EQ(report.isolated_points, 4U);
  EXPECT_EQ(report.flying_pixels, 0U);
  EXPECT_EQ(states(140, 70), PointState::isolated);
  EXPECT_EQ(states(150, 70), PointState::absent);
  EXPECT_EQ(count(states, PointState::kept), 100U * 140U);
}

TEST(FindArtifacts, RemovesTheFlyingPixelsOfASilhouetteAndNothingElse) {
  const Lens lens = scenes::camera();
  // Mixed pixels a column or two wide between surfaces 40 mm apart.
  for (const int mixed : {1, 2}) {
    const PointGrid grid = scenes::grid(lens, [&](int x, int) {
      if (x < 80) return 1000.0;
      return x < 80 + mixed ? 1000 + 40.0 * (x - 79) / (mixed + 1) : 1040.0;
    });
    CleanReport report;
    const Image<PointState> states = find_artifacts(grid, lens, {}, report);
    for (int y = 0; y < lens.size.height; ++y) {
      for (int x = 0; x < lens.size.width; ++x) {
        const bool flies = x >= 80 && x < 80 + mixed;
        ASSERT_EQ(states(x, y) == PointState::kept, !flies) << x << ' ' << y;
      }
    }
    EXPECT_EQ(report.isolated_points + report.flying_pixels,
              static_cast<std::size_t>(mixed * lens.size.height));
  }
}

TEST(FindArtifacts, RemovesASpikeButNotASharpBump) {
  const Lens lens = scenes::camera();
  // A cosine bump 2 mm across and 0.5 mm high is the finest relief asked for.
  const PointGrid relief = scenes::grid(lens, [&](int x, int y) {
    const double r = std::hypot(x - 100, y - 70) * 1050 / lens.fx;
    return 1050 - (r < 1 ? 0.25 * (1 + std::cos(std::numbers::pi * r)) : 0);
  });
  CleanReport report;
  EXPECT_EQ(count(find_artifacts(relief, lens, {}, report), PointState::kept), lens.size.area());

  PointGrid spiked = scenes::grid(lens, [](int, int) { return 1050.0; });
  spiked.points(60, 50) = scenes::point_at(lens, 60, 50, 1052.5);
  const Image<PointState> states = find_artifacts(spiked, lens, {}, report);
  EXPECT_EQ(states(60, 50), PointState::flying);
  EXPECT_EQ(report.flying_pixels, 1U);
}

TEST(FindArtifacts, RemovesARimThatLeavesItsSurface) {
  const Lens lens = scenes::camera();
  // A mixed column on the rim of a plate, 1.3 mm (two footprints) behind it: no steeper than a surface may
  // be.
  const auto plate = [](int x, int) { return x < 80 ? 1000.0 : x == 80 ? 1001.3 : double{scenes::none}; };
  CleanReport report;
  const Image<PointState> states = find_artifacts(scenes::grid(lens, plate), lens, {}, report);
  // At the column's ends the rim's own points are the surface behind.
  for (int y = 2; y < 138; ++y) EXPECT_EQ(states(80, y), PointState::flying) << y;
  EXPECT_EQ(count(states, PointState::kept) + report.flying_pixels, 81U * 140U);
  EXPECT_LE(report.flying_pixels, 140U);
  EXPECT_EQ(states(79, 70), PointState::kept);
  // Inside a surface the same step is relief, and an uncertain rim is not judged that finely.
  const auto step = [](int x, int) { return x < 80 ? 1000.0 : 1001.3; };
  EXPECT_EQ(count(find_artifacts(scenes::grid(lens, step), lens, {}, report), PointState::flying), 0U);
  EXPECT_EQ(count(find_artifacts(scenes::grid(lens, plate, 0.3F), lens, {}, report), PointState::flying), 0U);
}

TEST(FindArtifacts, KeepsTheRimOfARoundSurface) {
  // A cylinder of 30 mm radius to where it is seen at 75 degrees.
  const Lens lens = scenes::camera();
  const auto cylinder = [&](int x, int) {
    const double across = (x - lens.cx) / lens.fx * 1050 / 30;
    return std::abs(across) < std::sin(75 * std::numbers::pi / 180)
               ? 1080 - 30 * std::sqrt(1 - across * across)
               : double{scenes::none};
  };
  CleanReport report;
  find_artifacts(scenes::grid(lens, cylinder), lens, {}, report);
  EXPECT_EQ(report.isolated_points + report.flying_pixels, 0U);
}

TEST(FindArtifacts, AnUncertainPointMayStandOutFurther) {
  const Lens lens = scenes::camera();
  PointGrid grid = scenes::grid(lens, [](int, int) { return 1050.0; });
  grid.points(60, 50) = scenes::point_at(lens, 60, 50, 1051.6);
  CleanReport report;
  EXPECT_EQ(find_artifacts(grid, lens, {}, report)(60, 50), PointState::flying);
  grid.sigma_mm(60, 50) = 0.3F;
  EXPECT_EQ(find_artifacts(grid, lens, {}, report)(60, 50), PointState::kept);
}

TEST(FindArtifacts, IsTheSameAtEveryInstructionSet) {
  const Lens lens = scenes::camera();
  scenes::Noise noise(1.0);
  const PointGrid grid = scenes::grid(
      lens, [&](int, int) { return noise() > 0.9 ? double{scenes::none} : 1050 + noise(); }, 0.1F);
  const InstructionSet best = active_instruction_set();
  CleanReport report;
  ASSERT_TRUE(force_instruction_set(InstructionSet::v2));
  const Image<PointState> plain = find_artifacts(grid, lens, {}, report);
  EXPECT_GT(report.flying_pixels, 100U);
  for (const InstructionSet level : {InstructionSet::v3, InstructionSet::v4}) {
    if (!force_instruction_set(level)) continue;
    const Image<PointState> states = find_artifacts(grid, lens, {}, report);
    // Fused multiply-adds round differently: only points at a threshold may change.
    int different = 0;
    for (std::size_t i = 0; i < lens.size.area(); ++i) different += plain.data()[i] != states.data()[i];
    EXPECT_LE(different, 2);
  }
  force_instruction_set(best);
}

TEST(CleanOptions, ChecksRanges) {
  EXPECT_TRUE(CleanOptions{}.check());
  EXPECT_EQ(CleanOptions{.support_incidence_deg = 90}.check().error().message,
            "clean: support_incidence_deg: not between 0 and 90");
  EXPECT_EQ(CleanOptions{.min_support = 25}.check().error().message,
            "clean: min_support: not between 0 and 24");
  EXPECT_FALSE(CleanOptions{.flying_incidence_deg = 0}.check());
  EXPECT_FALSE(CleanOptions{.spike_footprints = 0}.check());
  EXPECT_FALSE(CleanOptions{.spike_sigmas = -1}.check());
  EXPECT_FALSE(CleanOptions{.rim_footprints = 0}.check());
  EXPECT_FALSE(CleanOptions{.rim_sigmas = -1}.check());
}

}  // namespace
}  // namespace bodyscan
