#include "pipeline/capture_check/motion.hpp"

#include "pipeline/image/srgb.hpp"
#include "tests/pipeline/capture_check/photographed_texture.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

FloatImage noisy(const FloatImage& image, float sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, sigma);
  FloatImage result = image.clone();
  for (float& pixel : result.pixels()) pixel += noise(random);
  return result;
}

// The length of the largest difference from `moved`.
double largest_error(const std::vector<TileMotion>& tiles, const Vector2d& moved) {
  double error = 0;
  for (const TileMotion& tile : tiles) error = std::max(error, (tile.moved - moved).norm());
  return error;
}

constexpr std::size_t tiles_of_texture = 12 * 8;  // 32 px each, more than 6 px from the border

TEST(MotionBetween, FindsShiftsOnATexture) {
  const FloatImage& before = texture_at_rest();
  for (const double length : {0.0, 0.3, 2.0, 4.0}) {
    for (const double angle : {0.7, 4.5}) {
      const Vector2d moved = length * Vector2d(std::cos(angle), std::sin(angle));
      const auto tiles = motion_between(before, texture(moved), 1);
      EXPECT_EQ(tiles.size(), tiles_of_texture) << moved.transpose();
      EXPECT_LT(largest_error(tiles, moved), 0.1) << moved.transpose();
      EXPECT_NEAR(usual_motion_px(tiles), length, 0.1);
    }
  }
}

TEST(MotionBetween, CountsInPixelsOfThePhotograph) {
  const auto tiles = motion_between(texture_at_rest(), texture({0.5, -1}), 4);
  ASSERT_EQ(tiles.size(), tiles_of_texture);
  EXPECT_EQ(tiles[0].at, Vector2d(4 * 22, 4 * 22));
  EXPECT_EQ(tiles[1].at, Vector2d(4 * 54, 4 * 22));
  EXPECT_LT(largest_error(tiles, {2, -4}), 0.4);
}

TEST(MotionBetween, WhatMovedTooFarIsNotTakenForStill) {
  const auto tiles = motion_between(texture_at_rest(), texture({25, 11}), 1);
  EXPECT_GT(usual_motion_px(tiles), 3);
}

TEST(MotionBetween, NoiseMovesNothing) {
  for (const float sigma : {0.002F, 0.01F}) {
    const auto tiles =
        motion_between(noisy(texture_at_rest(), sigma, 1), noisy(texture_at_rest(), sigma, 2), 1);
    EXPECT_GT(tiles.size(), tiles_of_texture * 9 / 10);
    EXPECT_LT(usual_motion_px(tiles), 0.1) << sigma;
  }
}

TEST(MotionBetween, AFlatPictureTellsNothing) {
  const FloatImage flat(texture_size, 0.5F);
  EXPECT_TRUE(motion_between(flat, flat, 1).empty());
  for (const float sigma : {0.0005F, 0.002F, 0.01F})
    EXPECT_TRUE(motion_between(noisy(flat, sigma, 1), noisy(flat, sigma, 2), 1).empty()) << sigma;
  EXPECT_EQ(usual_motion_px({}), 0);
}

TEST(MotionBetween, ALampThatFlickersMovesNothing) {
  FloatImage shaded(texture_size);
  for (int y = 0; y < shaded.height(); ++y)
    for (int x = 0; x < shaded.width(); ++x)
      shaded(x, y) = 0.2F + 0.001F * static_cast<float>(x) + (y < 150 ? 0.2F * texture_at_rest()(x, y) : 0);
  FloatImage darker = shaded.clone();
  for (float& pixel : darker.pixels()) pixel *= 0.98F;
  EXPECT_LT(usual_motion_px(motion_between(shaded, darker, 1)), 0.1);
}

TEST(MotionBetween, AnEdgeTellsOnlyTheMotionAcross) {
  // An edge of unit direction `along`, a few pixels wide, through every tile.
  const Vector2d across = Vector2d(2, 1).normalized();
  const auto edges = [&](const Vector2d& moved) {
    FloatImage image(texture_size);
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        image(x, y) = static_cast<float>(0.5 + 0.3 * std::sin(0.25 * across.dot(Vector2d(x, y) - moved)));
    return image;
  };
  const Vector2d moved(1.5, -1);
  const auto tiles = motion_between(edges({0, 0}), edges(moved), 1);
  ASSERT_EQ(tiles.size(), tiles_of_texture);
  EXPECT_LT(largest_error(tiles, across * across.dot(moved)), 0.1);
}

TEST(MotionBetween, APictureSmallerThanATileTellsNothing) {
  const FloatImage small = texture({0, 0}, {40, 300});
  EXPECT_TRUE(motion_between(small, small, 1).empty());
}

TEST(UsualMotion, NineOfTenDoNotExceedIt) {
  std::vector<TileMotion> tiles;
  for (int i = 0; i < 20; ++i) tiles.push_back({{i, 0}, {0, i == 7 ? 100 : 1}});
  EXPECT_EQ(usual_motion_px(tiles), 1);
}

TEST(MotionFactor, LeavesAboutAThousandPixels) {
  EXPECT_EQ(motion_factor({400, 300}), 1);
  EXPECT_EQ(motion_factor({1999, 300}), 1);
  EXPECT_EQ(motion_factor({4288, 2848}), 4);
}

TEST(Reduce, AveragesLight) {
  // 0 and 255 in equal shares: half the light, where encoded values would give 0.2.
  GrayImage8 photograph({5, 3}, 0);
  photograph(0, 0) = photograph(1, 1) = 255;
  photograph(2, 0) = photograph(3, 0) = photograph(2, 1) = photograph(3, 1) = 188;
  FloatImage reduced = reduce(photograph.clone(), 2);
  ASSERT_EQ(reduced.size(), (Size{2, 1}));  // what is left over is no square
  EXPECT_NEAR(reduced(0, 0), 0.5, 1e-4);
  EXPECT_NEAR(reduced(1, 0), srgb_to_linear(188 / 255.0), 1e-4);
  reduced = reduce(photograph.clone(), 2, {ToneResponse::Kind::linear});
  EXPECT_NEAR(reduced(1, 0), 188 / 255.0, 1e-4);
  GrayImage16 wide({2, 2}, 0);
  wide(0, 1) = 65535;
  wide(1, 1) = 30000;
  EXPECT_NEAR(reduce(wide.clone(), 2)(0, 0), (1 + srgb_to_linear(30000 / 65535.0)) / 4, 1e-4);
  EXPECT_NEAR(reduce(wide.clone(), 1)(1, 1), srgb_to_linear(30000 / 65535.0), 1e-4);
}

}  // namespace
}  // namespace bodyscan
