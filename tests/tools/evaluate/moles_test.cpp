#include "tools/evaluate/moles.hpp"

#include "tests/tools/evaluate/scenes.hpp"

#include <cmath>
#include <numbers>

namespace bodyscan {
namespace {

using Eigen::Vector3d;

constexpr Rgb8 skin{200, 160, 140};
constexpr Rgb8 dark{110, 70, 60};

// A wall with a dark spot of 16 mm, 13 pixels, and a photograph of it.
struct SpottedWall {
  Truth truth = make_wall(1000);
  ColorImage8 white{small_camera().size, skin};
  Mole mole{Vector3d(10, 5, 1000), 16};

  SpottedWall() {
    truth.facts.moles.push_back(mole);
    for (int y = 0; y < white.height(); ++y) {
      for (int x = 0; x < white.width(); ++x) {
        const Point3f& at = truth.points(x, y);
        if (std::hypot(at.x - mole.center.x(), at.y - mole.center.y()) < mole.diameter / 2)
          white(x, y) = dark;
      }
    }
  }

  // Every `step`-th pixel a point with the photograph's colour, joined to a grid.
  [[nodiscard]] Mesh model(int step) const {
    Mesh mesh;
    const int columns = (white.width() - 1) / step + 1;
    const int rows = (white.height() - 1) / step + 1;
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        mesh.points.push_back(truth.points(i * step, j * step));
        mesh.colors.push_back(white(i * step, j * step));
        if (i + 1 == columns || j + 1 == rows) continue;
        const auto corner = static_cast<std::uint32_t>(j * columns + i);
        const auto below = corner + static_cast<std::uint32_t>(columns);
        mesh.faces.push_back({corner, below, corner + 1});
        mesh.faces.push_back({corner + 1, below, below + 1});
      }
    }
    return mesh;
  }
};

TEST(Moles, AFullModelKeepsThemWhole) {
  const SpottedWall wall;
  const std::vector<MoleResult> moles = measure_moles(wall.truth, wall.model(1), wall.white);
  ASSERT_EQ(moles.size(), 1U);
  EXPECT_NEAR(moles[0].contrast_kept, 1, 1e-3);
  EXPECT_EQ(moles[0].covered, 1);
  EXPECT_NEAR(static_cast<double>(moles[0].pixels), std::numbers::pi * 16 * 16 * 0.8 * 0.8, 30);
}

TEST(Moles, APointCloudColoursItsPixels) {
  const SpottedWall wall;
  Mesh cloud = wall.model(1);
  cloud.faces.clear();
  const std::vector<MoleResult> moles = measure_moles(wall.truth, cloud, wall.white);
  ASSERT_EQ(moles.size(), 1U);
  EXPECT_NEAR(moles[0].contrast_kept, 1, 1e-3);
}

TEST(Moles, ACoarseModelLosesThem) {
  const SpottedWall wall;
  const std::vector<MoleResult> moles = measure_moles(wall.truth, wall.model(13), wall.white);
  ASSERT_EQ(moles.size(), 1U);
  EXPECT_LT(moles[0].contrast_kept, 0.6);
  EXPECT_EQ(moles[0].covered, 1);
}

TEST(Moles, WhatTheModelDoesNotCoverIsNotKept) {
  const SpottedWall wall;
  const std::vector<MoleResult> moles = measure_moles(wall.truth, Mesh{}, wall.white);
  ASSERT_EQ(moles.size(), 1U);
  EXPECT_EQ(moles[0].covered, 0);
  EXPECT_EQ(moles[0].contrast_kept, 0);
}

TEST(Moles, PartlyHiddenOnesAreNotJudged) {
  SpottedWall wall;
  const Eigen::Vector2d center = small_camera().project(wall.mole.center);
  wall.truth.reachable(static_cast<int>(center.x()), static_cast<int>(center.y())) = 0;
  EXPECT_TRUE(measure_moles(wall.truth, wall.model(1), wall.white).empty());
}

}  // namespace
}  // namespace bodyscan
