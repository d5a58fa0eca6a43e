#include "tools/simulator/projected_picture.hpp"

#include "tools/simulator/projected_chessboard.hpp"
#include "tools/simulator/projected_light.hpp"

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

constexpr Size projector{96, 64};
constexpr double defocus = 0.55;
constexpr double scattered = 2.46;

FloatImage light_of(const Pattern& pattern) {
  const GrayImage8 picture = render_pattern(pattern, projector);
  FloatImage light(projector);
  for (std::size_t i = 0; i < light.pixels().size(); ++i)
    light.pixels()[i] = picture.pixels()[i] != 0 ? 1.0F : 0.0F;
  return light;
}

TEST(ProjectedPicture, KnowsAlongWhichAxisItChanges) {
  EXPECT_EQ(changing_axis(light_of({PatternKind::gray, Axis::row, 1, false})), Axis::row);
  EXPECT_EQ(changing_axis(light_of({PatternKind::gray, Axis::column, 1, false})), Axis::column);
  EXPECT_EQ(changing_axis(light_of({.kind = PatternKind::black})), Axis::row);
  FloatImage picture = light_of({PatternKind::gray, Axis::row, 1, false});
  picture(50, 60) = 0.5F;
  EXPECT_EQ(changing_axis(picture), std::nullopt);
}

TEST(ProjectedPicture, AgreesWithTheExactBlurAlongEachAxis) {
  for (const Axis axis : {Axis::row, Axis::column}) {
    const Pattern pattern{PatternKind::gray, axis, 1, false};
    const ProjectedLight exact(pattern, projector, defocus, scattered);
    const ProjectedPicture picture(light_of(pattern), defocus, scattered);
    EXPECT_NEAR(picture.mean(), exact.mean(), 1e-5);
    for (float at = -0.5F; at <= 63.5F; at += 0.037F) {
      const BlurredRow::Value wanted = exact.at(at);
      const BlurredRow::Value value = axis == Axis::row ? picture.at(20.3F, at) : picture.at(at, 20.3F);
      ASSERT_NEAR(value.focused, wanted.focused, 0.01) << at;
      ASSERT_NEAR(value.focused + value.scatter_change, wanted.focused + wanted.scatter_change, 0.01) << at;
    }
  }
}

TEST(ProjectedPicture, AgreesWithTheChessboardInBothAxes) {
  const ProjectedBoard board = fit_projected_board(projector, 7, 5, 0.8);
  FloatImage light(projector, 1);
  const auto squares_before = [&](double pixel, double first_corner) {
    return static_cast<int>(std::floor((pixel - first_corner) / board.square_px)) + 1;
  };
  for (int y = 0; y < projector.height; ++y) {
    for (int x = 0; x < projector.width; ++x) {
      const int i = squares_before(x, board.first_corner_px.x());
      const int j = squares_before(y, board.first_corner_px.y());
      if (i >= 0 && i <= 7 && j >= 0 && j <= 5 && (i + j) % 2 == 0) light(x, y) = 0;
    }
  }
  const ProjectedChessboard exact(board, projector, defocus, scattered);
  const ProjectedPicture picture(light, defocus, scattered);
  EXPECT_NEAR(picture.mean(), exact.mean(), 1e-5);
  for (float y = -0.5F; y <= 63.5F; y += 0.37F) {
    for (float x = -0.5F; x <= 95.5F; x += 0.41F) {
      ASSERT_NEAR(picture.at(x, y).focused, exact.at(x, y).focused, 0.02) << x << ' ' << y;
      ASSERT_NEAR(picture.at(x, y).scatter_change, exact.at(x, y).scatter_change, 0.03) << x << ' ' << y;
    }
  }
}

}  // namespace
}  // namespace bodyscan::simulator
