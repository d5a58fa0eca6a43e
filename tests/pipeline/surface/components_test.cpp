#include "pipeline/surface/components.hpp"

#include "pipeline/surface/surface.hpp"
#include "tests/pipeline/surface/scenes.hpp"

#include <functional>
#include <map>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

TEST(RemoveSmallComponents, RemovesPatchesBelowTheArea) {
  const Lens lens = scenes::camera();
  // 0.66 mm a pixel at 1050 mm: a patch of 7 x 7 covers 21 mm^2, one of 8 x 8 28 mm^2.
  const auto depth = [](int x, int y) {
    if (x < 100) return 1050.0;
    const bool small = x >= 120 && x < 127 && y >= 20 && y < 27;
    const bool large = x >= 150 && x < 158 && y >= 60 && y < 68;
    return small || large ? 1050.0 : double{scenes::none};
  };
  SurfaceReport report;
  const GridMesh mesh = build_surface(scenes::grid(lens, depth), lens, {}, report).value();
  EXPECT_EQ(report.components.components, 2U);
  EXPECT_EQ(report.components.small_components, 1U);
  EXPECT_EQ(report.components.small_component_points, 49U);
  EXPECT_FALSE(mesh.has(123, 23));
  EXPECT_TRUE(mesh.has(153, 63));
  EXPECT_EQ(mesh.point_count(), 100U * 140U + 64U);
}

TEST(RemoveSmallComponents, MeasuresAreaInMillimetres) {
  const Lens lens = scenes::camera();
  // The patch of 7 x 7 pixels that is too small at 1050 mm is large enough at 1250 mm.
  for (const auto& [z, kept] : {std::pair{1050.0, 0U}, {1250.0, 49U}}) {
    const auto depth = [patch = z](int x, int y) {
      return x >= 20 && x < 27 && y >= 20 && y < 27 ? patch : double{scenes::none};
    };
    SurfaceReport report;
    EXPECT_EQ(build_surface(scenes::grid(lens, depth), lens, {}, report).value().point_count(), kept);
  }
}

TEST(RemoveSmallComponents, KeepsAnIslandInItsSurfaceButNoFloater) {
  const Lens lens = scenes::camera();
  // A disc of 3 mm in a ring without points; the gap is 2 mm wide.
  for (const auto& [height, kept] : {std::pair{0.0, true}, {2.0, true}, {15.0, false}, {-15.0, false}}) {
    const auto depth = [above = height](int x, int y) {
      const double r = std::hypot(x - 100, y - 70) * 1050 / 1590;
      return r < 1.5 ? 1050 - above : r < 3.5 ? double{scenes::none} : 1050.0;
    };
    SurfaceReport report;
    const GridMesh mesh = build_surface(scenes::grid(lens, depth), lens, {}, report).value();
    EXPECT_EQ(mesh.has(100, 70), kept) << height;
    EXPECT_EQ(report.components.small_components, kept ? 0U : 1U);
  }
}

TEST(RemoveSmallComponents, RemovesASmallPieceTooFarFromItsSurface) {
  const Lens lens = scenes::camera();
  for (const auto& [columns, kept] : {std::pair{5, true}, {12, false}}) {
    const auto depth = [gap = columns](int x, int y) {
      const bool piece = x >= 60 + gap && x < 65 + gap && y >= 60 && y < 65;
      return x < 60 || piece ? 1050.0 : double{scenes::none};
    };
    SurfaceReport report;
    const GridMesh mesh = build_surface(scenes::grid(lens, depth), lens, {}, report).value();
    EXPECT_EQ(mesh.has(62 + columns, 62), kept) << columns;
  }
}

TEST(RemoveSmallComponents, CountsAMeanderAsOne) {
  // Strips that join at alternate ends, over more rows than are labelled together.
  const Lens lens = scenes::camera(200, 300);
  const auto depth = [](int x, int y) {
    const int strip = y / 10;
    const bool joint = strip % 4 == 1 ? x < 10 : x >= 190;
    return strip % 2 == 0 || joint ? 1000.0 : double{scenes::none};
  };
  SurfaceReport report;
  const GridMesh mesh = build_surface(scenes::grid(lens, depth), lens, {}, report).value();
  EXPECT_EQ(report.components.components, 1U);
  EXPECT_EQ(report.components.small_components, 0U);
  EXPECT_EQ(mesh.point_count(), 15U * 10U * 210U);
}

// Components of random cells, by flooding the points' graph.
std::multiset<std::size_t> flooded_sizes(const Mesh& mesh) {
  std::vector<std::vector<std::uint32_t>> neighbours(mesh.points.size());
  for (const Face& face : mesh.faces) {
    for (const std::uint32_t p : face) {
      for (const std::uint32_t q : face) neighbours[p].push_back(q);
    }
  }
  std::multiset<std::size_t> sizes;
  std::vector<bool> seen(mesh.points.size());
  for (std::uint32_t start = 0; start < mesh.points.size(); ++start) {
    if (seen[start]) continue;
    std::vector<std::uint32_t> open{start};
    seen[start] = true;
    std::size_t size = 0;
    while (!open.empty()) {
      const std::uint32_t p = open.back();
      open.pop_back();
      ++size;
      for (const std::uint32_t q : neighbours[p]) {
        if (!seen[q]) open.push_back(q);
        seen[q] = true;
      }
    }
    sizes.insert(size);
  }
  return sizes;
}

TEST(RemoveSmallComponents, AgreesWithFloodingOnRandomCells) {
  const Lens lens = scenes::camera(60, 300);
  std::mt19937 random(3);
  for (const unsigned missing : {2U, 4U, 8U}) {
    const auto cells = [&] {
      Image<std::uint8_t> result(lens.size, 0);
      for (int y = 0; y + 1 < lens.size.height; ++y) {
        for (int x = 0; x + 1 < lens.size.width; ++x) {
          const unsigned code = random() % 8;
          result(x, y) = static_cast<std::uint8_t>(random() % 8 < missing || !(code & 3) ? 0U : code);
        }
      }
      return result;
    }();
    const auto plane = [](int, int) { return 1000.0; };
    const GridMesh before(scenes::grid(lens, plane), cells.clone());
    const std::multiset<std::size_t> sizes = flooded_sizes(before.to_mesh());
    const double pixel_mm2 = 1000.0 * 1000.0 / (lens.fx * lens.fy);

    Image<std::uint8_t> cleaned = cells.clone();
    ComponentReport report;
    remove_small_components(before.grid(), lens, {.min_component_mm2 = 9.5 * pixel_mm2, .island_gap_mm = 0},
                            cleaned, report);
    const GridMesh after(scenes::grid(lens, plane), std::move(cleaned));
    std::multiset<std::size_t> expected;
    std::size_t removed = 0;
    for (const std::size_t size : sizes) {
      if (size > 9) expected.insert(size);
      if (size <= 9) removed += size;
    }
    EXPECT_EQ(flooded_sizes(after.to_mesh()), expected);
    EXPECT_EQ(report.components, expected.size());
    EXPECT_EQ(report.small_components, sizes.size() - expected.size());
    EXPECT_EQ(report.small_component_points, removed);
  }
}

TEST(ComponentOptions, ChecksRanges) {
  EXPECT_TRUE(ComponentOptions{}.check());
  EXPECT_EQ(ComponentOptions{.min_component_mm2 = -1}.check().error().message,
            "components: min_component_mm2: negative");
  EXPECT_FALSE(ComponentOptions{.island_gap_mm = -1}.check());
}

}  // namespace
}  // namespace bodyscan
