#include "pipeline/surface/color.hpp"

#include "pipeline/surface/surface.hpp"
#include "tests/pipeline/surface/scenes.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

// IEC 61966-2-1, written out once more.
double linear(double level) {
  const double v = level / 255;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}
double encoded(double light) {
  return 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055);
}

TEST(SurfaceColor, SubtractsTheBlackLevelInLinearLight) {
  ColorImage8 white({256, 256});
  ColorImage8 black({256, 256});
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      const auto level = [](int value) { return static_cast<std::uint8_t>(value); };
      white(x, y) = {level(x), level(255 - x), level(x / 2)};
      black(x, y) = {level(y), level(y), level(y / 4)};
    }
  }
  const ColorImage8 image = SurfaceColor::create(white, black).value().image();
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double light = linear(white(x, y)[i]) - linear(black(x, y)[i]);
        const double expected = light <= 0 ? 0 : encoded(light);
        ASSERT_NEAR(image(x, y)[i], expected, expected < 10 ? 0.9 : 0.65) << x << ' ' << y << ' ' << i;
      }
    }
  }
}

TEST(SurfaceColor, KeepsTheWhiteFrameOverATrueBlack) {
  ColorImage8 white({256, 1});
  for (int x = 0; x < 256; ++x) white(x, 0).fill(static_cast<std::uint8_t>(x));
  for (const ColorImage8& black : {ColorImage8(), ColorImage8({256, 1}, Rgb8{0, 0, 0})}) {
    const ColorImage8 image = SurfaceColor::create(white, black).value().image();
    for (int x = 0; x < 256; ++x) EXPECT_EQ(image(x, 0), white(x, 0));
  }
}

TEST(SurfaceColor, CorrectsInLinearLightAndClips) {
  const ColorImage8 white({1, 1}, Rgb8{200, 100, 50});
  const ColorImage8 black({1, 1}, Rgb8{20, 20, 20});
  const std::array<double, 9> matrix{0.5, 0.25, 0, 0, 4, 0, -1, 0, 0.5};
  const Rgb8 color = SurfaceColor::create(white, black, {.correction = matrix}).value().image()(0, 0);
  const double red = linear(200) - linear(20);
  const double green = linear(100) - linear(20);
  EXPECT_NEAR(color[0], encoded(0.5 * red + 0.25 * green), 0.7);
  EXPECT_NEAR(color[1], encoded(4 * green), 0.7);
  EXPECT_EQ(color[2], 0);
  const std::array<double, 9> bright{9, 9, 9, 9, 9, 9, 9, 9, 9};
  EXPECT_EQ(SurfaceColor::create(white, black, {.correction = bright}).value().image()(0, 0),
            (Rgb8{255, 255, 255}));
}

TEST(SurfaceColor, RefusesOtherSizesAndBadMatrices) {
  const ColorImage8 white({4, 3}, Rgb8{});
  const ColorImage8 black({4, 2}, Rgb8{});
  EXPECT_EQ(SurfaceColor::create(white, black).error().message,
            "black frame: 4 x 2 pixels, the white frame has 4 x 3");
  ColorOptions options;
  options.correction.emplace();
  options.correction->back() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(SurfaceColor::create(white, {}, options).error().message, "color: correction: not finite");
}

TEST(SurfaceColor, GivesEachVertexItsPixelsColor) {
  const Lens lens = scenes::camera();
  const auto depth = [](int x, int y) { return (x - y) % 50 == 0 ? double{scenes::none} : 1000.0; };
  SurfaceReport report;
  const GridMesh mesh = build_surface(scenes::grid(lens, depth), lens, {}, report).value();
  ColorImage8 white(lens.size);
  for (int y = 0; y < lens.size.height; ++y) {
    for (int x = 0; x < lens.size.width; ++x) {
      white(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 77};
    }
  }
  const ColorImage8 black;
  const SurfaceColor colors = SurfaceColor::create(white, black).value();
  const Mesh whole = mesh.to_mesh(&colors);
  ASSERT_EQ(whole.colors.size(), whole.points.size());
  std::size_t number = 0;
  for (int y = 0; y < lens.size.height; ++y) {
    for (int x = 0; x < lens.size.width; ++x) {
      if (mesh.has(x, y)) {
        ASSERT_EQ(whole.colors[number++], white(x, y));
      }
    }
  }
}

}  // namespace
}  // namespace bodyscan
