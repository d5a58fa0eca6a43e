#include "pipeline/decode/illumination.hpp"

#include "pipeline/decode/response.hpp"

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr ToneResponse linear{ToneResponse::Kind::linear, 1};

template <class Pixel>
Luma two_pixels(int first, int second) {
  Image<Pixel> image({2, 1});
  image(0, 0) = static_cast<Pixel>(first);
  image(1, 0) = static_cast<Pixel>(second);
  return image;
}

TEST(Illumination, CountsPixelsAtTheThresholdAndNotBelow) {
  const auto light = measure_illumination(two_pixels<std::uint8_t>(25, 24), two_pixels<std::uint8_t>(20, 20),
                                          5, linear_table(linear, 8));
  ASSERT_TRUE(light.has_value());
  EXPECT_EQ(light->pixels_lit, 1U);
  EXPECT_NEAR(light->contrast(0, 0), 5.0 / 255 * linear_full_scale, 1);
  EXPECT_EQ(light->contrast(1, 0), 0);
}

TEST(Illumination, MeansTheSameLevelsInSixteenBits) {
  const auto light =
      measure_illumination(two_pixels<std::uint16_t>(20 * 257 + 1285, 20 * 257 + 1284),
                           two_pixels<std::uint16_t>(20 * 257, 20 * 257), 5, linear_table(linear, 16));
  ASSERT_TRUE(light.has_value());
  EXPECT_EQ(light->pixels_lit, 1U);
  EXPECT_NEAR(light->contrast(0, 0), 5.0 / 255 * linear_full_scale, 1);
}

TEST(Illumination, APixelBrighterInBlackIsNotLit) {
  const auto light = measure_illumination(two_pixels<std::uint8_t>(200, 10), two_pixels<std::uint8_t>(20, 90),
                                          5, linear_table(linear, 8));
  ASSERT_TRUE(light.has_value());
  EXPECT_EQ(light->pixels_lit, 1U);
  EXPECT_EQ(light->contrast(1, 0), 0);
}

TEST(Illumination, EveryPixelCountedAsLitHasContrast) {
  // At gamma 3 five grey levels out of black are less than one unit of linear light.
  const auto light = measure_illumination(two_pixels<std::uint8_t>(5, 200), two_pixels<std::uint8_t>(0, 0), 5,
                                          linear_table({ToneResponse::Kind::gamma, 3}, 8));
  ASSERT_TRUE(light.has_value());
  EXPECT_EQ(light->pixels_lit, light->contrast(0, 0) > 0 ? 2U : 1U);
}

TEST(Illumination, SaysWhatIsWrongWithTheLight) {
  const auto table = linear_table(linear, 8);
  const auto swapped =
      measure_illumination(two_pixels<std::uint8_t>(20, 20), two_pixels<std::uint8_t>(90, 20), 5, table);
  ASSERT_FALSE(swapped.has_value());
  EXPECT_NE(swapped.error().message.find("darker"), std::string::npos);
  const auto dark =
      measure_illumination(two_pixels<std::uint8_t>(24, 20), two_pixels<std::uint8_t>(20, 20), 5, table);
  ASSERT_FALSE(dark.has_value());
  EXPECT_NE(dark.error().message.find("nothing is lit"), std::string::npos);
  EXPECT_EQ(dark.error().kind, ErrorKind::input);
}

}  // namespace
}  // namespace bodyscan
