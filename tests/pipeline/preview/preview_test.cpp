#include "pipeline/preview/coarse_mesh.hpp"
#include "pipeline/preview/false_color.hpp"
#include "pipeline/preview/shaded_model.hpp"
#include "pipeline/surface/surface.hpp"
#include "tests/pipeline/surface/scenes.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

GridMesh build(PointGrid grid, const Lens& lens) {
  SurfaceReport report;
  return build_surface(std::move(grid), lens, {}, report).value();
}

int brightness(const Rgb8& color) {
  return color[0] + color[1] + color[2];
}

TEST(DepthPicture, RunsFromGreenToBlueWithBlackHoles) {
  const Lens lens = scenes::camera();
  const auto depth = [](int x, int) { return x < 40 ? double{scenes::none} : 1000 + 0.5 * (x - 40); };
  const ColorImage8 picture = depth_picture(build(scenes::grid(lens, depth), lens));
  ASSERT_EQ(picture.size(), lens.size);
  EXPECT_EQ(picture(20, 70), (Rgb8{0, 0, 0}));
  EXPECT_EQ(picture(40, 70), (Rgb8{0, 255, 0}));
  EXPECT_EQ(picture(199, 70), (Rgb8{0, 0, 255}));
  const Rgb8 middle = picture(120, 70);
  EXPECT_GT(middle[1], 230);
  EXPECT_GT(middle[2], 230);
}

TEST(DepthPicture, LeavesRemovedPointsOut) {
  const Lens lens = scenes::camera();
  PointGrid grid = scenes::grid(lens, [](int x, int) { return x < 100 ? 1000.0 : double{scenes::none}; });
  grid.points(150, 70) = scenes::point_at(lens, 150, 70, 1000);
  const ColorImage8 picture = depth_picture(build(std::move(grid), lens));
  EXPECT_EQ(brightness(picture(150, 70)), 0);
  EXPECT_GT(brightness(picture(50, 70)), 0);
}

TEST(CoordinatePicture, ScalesToTheProjectorAndShrinks) {
  FloatImage rows({1000, 10}, 0.F);
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 1000; ++x) rows(x, y) = x < 500 ? 0.F : x < 900 ? 767.F : scenes::none;
  }
  const ColorImage8 picture = coordinate_picture(rows, 768, 300);
  EXPECT_EQ(picture.size(), (Size{250, 3}));
  EXPECT_EQ(picture(10, 1), (Rgb8{0, 255, 0}));
  EXPECT_EQ(picture(200, 1), (Rgb8{0, 0, 255}));
  EXPECT_EQ(picture(240, 1), (Rgb8{0, 0, 0}));
}

TEST(CoarseMesh, AveragesNoiseButNotAcrossASilhouette) {
  const Lens lens = scenes::camera(400, 280);
  scenes::Noise noise(0.1);
  // The silhouette runs through the middle of a block.
  const auto depth = [&](int x, int) { return (x < 198 ? 1000.0 : 1060.0) + noise(); };
  const GridMesh mesh = build(scenes::grid(lens, depth, 0.1F), lens);
  const CoarseMesh coarse = coarse_mesh(mesh, nullptr, 4);
  ASSERT_EQ(coarse.vertices.size(), 100U * 70U);
  double sum = 0;
  for (const CoarseVertex& vertex : coarse.vertices) {
    const double height =
        std::min(std::abs(vertex.position.z() - 1000), std::abs(vertex.position.z() - 1060));
    EXPECT_LT(height, 0.3);
    sum += height * height;
  }
  EXPECT_LT(std::sqrt(sum / 7000), 0.04);
  EXPECT_EQ(coarse.faces.size(), 2U * 98U * 69U);
  for (const CoarseVertex& vertex : coarse.vertices) EXPECT_LT(vertex.normal.z(), -0.9);
}

// A dome before nothing, seen turned.
class ShadedModel : public testing::Test {
 protected:
  ShadedModel() {
    const auto depth = [&](int x, int y) {
      const double r2 = (std::pow(x - lens_.cx, 2) + std::pow(y - lens_.cy, 2)) / (60 * 60);
      return r2 < 0.9 ? 1040 - 40 * std::sqrt(1 - r2) : double{scenes::none};
    };
    mesh_ = build(scenes::grid(lens_, depth), lens_);
  }

  Lens lens_ = scenes::camera();
  GridMesh mesh_;
};

TEST_F(ShadedModel, FillsThePictureWithinTheLimits) {
  const ShadedModelOptions options{.max_width = 300, .max_height = 200};
  const ColorImage8 picture = shaded_model(mesh_, nullptr, options);
  EXPECT_EQ(picture.height(), 200);
  EXPECT_LE(picture.width(), 300);
  EXPECT_EQ(picture(0, 0), options.background);
  EXPECT_NE(picture(picture.width() / 2, 100), options.background);
  int covered = 0;
  for (const Rgb8& color : picture.pixels()) covered += color != options.background;
  EXPECT_GT(covered, picture.width() * picture.height() / 2);
}

TEST_F(ShadedModel, IsLitFromTheUpperLeft) {
  const ColorImage8 picture = shaded_model(mesh_, nullptr, {.max_width = 300, .max_height = 300});
  const int w = picture.width();
  const int h = picture.height();
  EXPECT_GT(brightness(picture(w * 2 / 5, h * 2 / 5)), brightness(picture(w * 2 / 3, h * 2 / 3)) + 60);
}

TEST_F(ShadedModel, ShowsTheVertexColors) {
  const ColorImage8 white(lens_.size, Rgb8{220, 60, 30});
  const ColorImage8 black;
  const SurfaceColor colors = SurfaceColor::create(white, black).value();
  const ColorImage8 picture = shaded_model(mesh_, &colors, {.max_width = 200, .max_height = 200});
  const Rgb8 middle = picture(picture.width() / 2, picture.height() / 2);
  EXPECT_GT(middle[0], 3 * middle[1]);
  EXPECT_GT(middle[1], middle[2]);
}

TEST_F(ShadedModel, AShallowDomeTurnedAwayIsNarrower) {
  const auto width_by_height = [&](double turn) {
    const ColorImage8 picture =
        shaded_model(mesh_, nullptr, {.max_width = 400, .turn_deg = turn, .tilt_deg = 0});
    return static_cast<double>(picture.width()) / picture.height();
  };
  EXPECT_LT(width_by_height(50), width_by_height(0) - 0.05);
}

TEST(ShadedModelOfNothing, IsTheBackground) {
  const Lens lens = scenes::camera();
  const GridMesh mesh = build(scenes::grid(lens, [](int, int) { return scenes::none; }), lens);
  const ColorImage8 picture = shaded_model(mesh, nullptr, {.max_width = 30, .max_height = 20});
  EXPECT_EQ(picture.size(), (Size{30, 20}));
  for (const Rgb8& color : picture.pixels()) EXPECT_EQ(color, ShadedModelOptions{}.background);
}

}  // namespace
}  // namespace bodyscan
