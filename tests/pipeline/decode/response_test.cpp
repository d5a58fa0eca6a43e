#include "pipeline/decode/response.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

const std::vector<ToneResponse> responses{{ToneResponse::Kind::srgb, 1},
                                          {ToneResponse::Kind::linear, 1},
                                          {ToneResponse::Kind::gamma, 2.2},
                                          {ToneResponse::Kind::gamma, 0.5}};

TEST(LinearTable, RunsFromDarkToFullScaleWithoutFalling) {
  for (const ToneResponse& response : responses) {
    for (const int bits : {8, 16}) {
      const auto table = linear_table(response, bits);
      ASSERT_EQ(table.size(), std::size_t{1} << bits);
      EXPECT_EQ(table.front(), 0);
      EXPECT_EQ(table.back(), linear_full_scale);
      EXPECT_TRUE(std::is_sorted(table.begin(), table.end()));
    }
  }
}

TEST(LinearTable, DifferencesFitSixteenBitsWithTheirSign) {
  EXPECT_LE(2 * linear_full_scale, 32767);
}

// IEC 61966-2-1: 0.0031308 of the light at the join, 0.21404 at half the code range.
TEST(LinearTable, SrgbFollowsTheStandard) {
  const auto table = linear_table({ToneResponse::Kind::srgb, 1}, 8);
  const auto expected = [](double light) { return light * linear_full_scale; };
  EXPECT_NEAR(table[10], expected(10 / 255.0 / 12.92), 0.51);
  EXPECT_NEAR(table[11], expected(0.0033465), 0.51);
  EXPECT_NEAR(table[64], expected(0.0512695), 0.51);
  EXPECT_NEAR(table[128], expected(0.2158605), 0.51);
  EXPECT_NEAR(table[188], expected(0.5028865), 0.51);
  EXPECT_NEAR(linear_table({ToneResponse::Kind::srgb, 1}, 16)[32768], expected(0.2140552), 0.51);
}

TEST(LinearTable, GammaIsAPowerAndLinearIsNone) {
  const auto square = linear_table({ToneResponse::Kind::gamma, 2}, 8);
  const auto straight = linear_table({ToneResponse::Kind::linear, 2}, 8);
  EXPECT_NEAR(square[51], 0.04 * linear_full_scale, 0.51);
  EXPECT_NEAR(straight[51], 0.2 * linear_full_scale, 0.51);
}

}  // namespace
}  // namespace bodyscan
