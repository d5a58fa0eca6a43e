#include "pipeline/base/image.hpp"

#include <type_traits>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

static_assert(!std::is_copy_constructible_v<GrayImage8> && std::is_nothrow_move_constructible_v<GrayImage8>);

TEST(Image, PixelsLieRowByRow) {
  GrayImage8 image({3, 2}, 0);
  image(2, 1) = 7;
  EXPECT_EQ(image.data()[5], 7);
  EXPECT_EQ(image.row(1)[2], 7);
  EXPECT_EQ(image.pixels().size(), 6U);
}

TEST(Image, FillReachesEveryPixel) {
  const GrayImage16 image({5, 4}, 513);
  for (const std::uint16_t pixel : image.pixels()) EXPECT_EQ(pixel, 513);
}

TEST(Image, CloneSharesNothing) {
  GrayImage8 image({2, 2}, 1);
  const GrayImage8 copy = image.clone();
  image(0, 0) = 9;
  EXPECT_EQ(copy(0, 0), 1);
  EXPECT_EQ(copy.size(), image.size());
}

TEST(Image, MovingLeavesAnEmptyImage) {
  GrayImage8 source({2, 2}, 1);
  const std::uint8_t* memory = source.data();
  GrayImage8 target = std::move(source);
  EXPECT_EQ(target.data(), memory);
  EXPECT_TRUE(source.empty());
  EXPECT_EQ(source.size(), Size{});
  source = std::move(target);
  EXPECT_EQ(source.data(), memory);
  EXPECT_TRUE(target.empty());
}

TEST(Image, AreaOfALargeImageDoesNotOverflow) {
  EXPECT_EQ((Size{70000, 70000}).area(), 4'900'000'000U);
}

}  // namespace
}  // namespace bodyscan
