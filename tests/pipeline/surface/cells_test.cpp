#include "pipeline/surface/cells.hpp"

#include "pipeline/base/instruction_set.hpp"
#include "tests/pipeline/surface/scenes.hpp"

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

struct Connected {
  Image<std::uint8_t> cells;
  MeshReport report;
};

Connected connect(const PointGrid& grid, const Lens& lens, const MeshOptions& options = {}) {
  Image<PointState> states(lens.size, PointState::kept);
  for (int y = 0; y < lens.size.height; ++y) {
    for (int x = 0; x < lens.size.width; ++x) {
      if (!grid.has(x, y)) states(x, y) = PointState::absent;
    }
  }
  Connected result;
  result.cells = connect_cells(grid, states, lens, options, result.report);
  return result;
}

std::size_t faces(const Image<std::uint8_t>& cells) {
  std::size_t sum = 0;
  for (const std::uint8_t code : cells.pixels()) sum += (code & 1U) + (code >> 1 & 1U);
  return sum;
}

TEST(ConnectCells, JoinsAllOfASurfaceUpToTheLimitAngle) {
  const Lens lens = scenes::camera();
  const std::size_t all = 2U * 199U * 139U;
  for (const auto& [degrees, joined] : {std::pair{0.0, true}, {75.0, true}, {81.0, true}, {84.0, false}}) {
    const double slope = std::tan(degrees * std::numbers::pi / 180);
    // Only the middle columns: an inclined plane is seen at other angles further out.
    const PointGrid grid = scenes::grid(
        lens,
        [&](int x, int) {
          return std::abs(x - 100) > 3 ? double{scenes::none} : scenes::inclined_plane(lens, x, 1050, slope);
        },
        0);
    const Connected result = connect(grid, lens);
    EXPECT_EQ(faces(result.cells), joined ? 2U * 6U * 139U : 0U) << degrees;
    EXPECT_EQ(result.report.edges_cut, joined ? 0U : 6U * 140U) << degrees;
  }
  EXPECT_EQ(faces(connect(scenes::grid(lens, [](int, int) { return 1000.0; }), lens).cells), all);
}

TEST(ConnectCells, CutsAtADepthDiscontinuity) {
  const Lens lens = scenes::camera();
  const Connected result =
      connect(scenes::grid(lens, [](int x, int) { return x < 50 ? 1000.0 : 1020.0; }), lens);
  EXPECT_EQ(result.report.edges_cut, 140U);
  EXPECT_EQ(result.report.faces_removed_by_area, 0U);
  EXPECT_EQ(faces(result.cells), 2U * 198U * 139U);
  for (int y = 0; y < 139; ++y) EXPECT_EQ(result.cells(49, y), 0);
}

TEST(ConnectCells, MeasuresTheJumpInPixelFootprints) {
  // The same step is a discontinuity close up and within a slope from far away.
  const Lens lens = scenes::camera();
  for (const auto& [z, cut] : {std::pair{300.0, true}, {3000.0, false}}) {
    const auto step = [near = z](int x, int) { return x < 50 ? near : near + 5; };
    EXPECT_EQ(connect(scenes::grid(lens, step), lens).report.edges_cut > 0, cut) << z;
  }
}

TEST(ConnectCells, AllowsForNoise) {
  const Lens lens = scenes::camera();
  const auto step = [](int x, int) { return x < 50 ? 1000.0 : 1005.0; };
  EXPECT_GT(connect(scenes::grid(lens, step, 0.01F), lens).report.edges_cut, 0U);
  EXPECT_EQ(connect(scenes::grid(lens, step, 0.6F), lens).report.edges_cut, 0U);
  EXPECT_GT(connect(scenes::grid(lens, step, 0.6F), lens, {.noise_sigmas = 0}).report.edges_cut, 0U);
}

TEST(ConnectCells, RemovesLargeTrianglesOnly) {
  const Lens lens = scenes::camera();
  // At 60 degrees a triangle has twice the area of one that faces the camera.
  const PointGrid grid = scenes::grid(lens, [&](int x, int) {
    return std::abs(x - 100) > 3 ? double{scenes::none}
                                 : scenes::inclined_plane(lens, x, 1050, std::tan(std::numbers::pi / 3));
  });
  EXPECT_EQ(connect(grid, lens, {.max_area = 2.05}).report.faces_removed_by_area, 0U);
  const Connected result = connect(grid, lens, {.max_area = 1.95});
  EXPECT_EQ(result.report.faces_removed_by_area, 2U * 6U * 139U);
  EXPECT_EQ(faces(result.cells), 0U);
}

TEST(ConnectCells, MakesOneTriangleOfThreePoints) {
  const Lens lens = scenes::camera(2, 2);
  const std::uint8_t expected[] = {cell::second | cell::anti,  // without a: (b, c, d)
                                   cell::first,                // without b: (a, c, d)
                                   cell::second,               // without c: (a, d, b)
                                   cell::first | cell::anti};  // without d: (a, c, b)
  for (int missing = 0; missing < 4; ++missing) {
    const auto depth = [&](int x, int y) { return 2 * y + x == missing ? double{scenes::none} : 1000.0; };
    const Connected result = connect(scenes::grid(lens, depth), lens);
    EXPECT_EQ(result.cells(0, 0), expected[missing]) << missing;
    EXPECT_EQ(result.report.edges_cut, 0U);
  }
}

TEST(ConnectCells, CutsACellAlongTheSmallerJump) {
  const Lens lens = scenes::camera(2, 2);
  const auto only_at = [&](int where) {
    const auto depth = [&](int x, int y) { return 2 * y + x == where ? 1001.0 : 1000.0; };
    return connect(scenes::grid(lens, depth), lens).cells(0, 0);
  };
  EXPECT_EQ(only_at(0), cell::full | cell::anti);
  EXPECT_EQ(only_at(3), cell::full | cell::anti);
  EXPECT_EQ(only_at(1), cell::full);
  EXPECT_EQ(only_at(2), cell::full);
}

TEST(ConnectCells, LeavesOutRemovedPoints) {
  const Lens lens = scenes::camera(3, 3);
  const PointGrid grid = scenes::grid(lens, [](int, int) { return 1000.0; });
  Image<PointState> states(lens.size, PointState::kept);
  states(1, 1) = PointState::flying;
  MeshReport report;
  EXPECT_EQ(faces(connect_cells(grid, states, lens, {}, report)), 4U);
}

TEST(ConnectCells, IsTheSameAtEveryInstructionSet) {
  const Lens lens = scenes::camera();
  scenes::Noise noise(2.0);
  const PointGrid grid = scenes::grid(
      lens, [&](int, int) { return noise() > 3 ? double{scenes::none} : 1050 + noise(); }, 0.1F);
  const InstructionSet best = active_instruction_set();
  ASSERT_TRUE(force_instruction_set(InstructionSet::v2));
  const Connected plain = connect(grid, lens);
  EXPECT_GT(plain.report.edges_cut, 100U);
  for (const InstructionSet level : {InstructionSet::v3, InstructionSet::v4}) {
    if (!force_instruction_set(level)) continue;
    const Connected result = connect(grid, lens);
    int different = 0;
    for (std::size_t i = 0; i < lens.size.area(); ++i)
      different += plain.cells.data()[i] != result.cells.data()[i];
    EXPECT_LE(different, 2);  // roundings of fused multiply-adds at a threshold
  }
  force_instruction_set(best);
}

TEST(MeshOptions, ChecksRanges) {
  EXPECT_TRUE(MeshOptions{}.check());
  EXPECT_EQ(MeshOptions{.max_incidence_deg = 95}.check().error().message,
            "mesh: max_incidence_deg: not between 0 and 90");
  EXPECT_FALSE(MeshOptions{.noise_sigmas = -1}.check());
  EXPECT_FALSE(MeshOptions{.max_area = 1}.check());
}

}  // namespace
}  // namespace bodyscan
