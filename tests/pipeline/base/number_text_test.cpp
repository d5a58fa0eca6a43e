#include "pipeline/base/number_text.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

TEST(NumberText, FixedHasThatManyDecimals) {
  EXPECT_EQ(fixed_text(12.345, 1), "12.3");
  EXPECT_EQ(fixed_text(-0.5, 3), "-0.500");
  EXPECT_EQ(fixed_text(std::numeric_limits<double>::max(), 2).size(), 312U);
}

TEST(NumberText, SignificantHasThatManyDigits) {
  EXPECT_EQ(significant_text(0.00123, 2), "0.0012");
  EXPECT_EQ(significant_text(0.15, 1), "0.1");
  EXPECT_EQ(significant_text(12, 2), "12");
  EXPECT_EQ(significant_text(1.5e-7, 2), "1.5e-07");
}

TEST(NumberText, ShortHasNoTrailingZeros) {
  EXPECT_EQ(short_text(25, 3), "25");
  EXPECT_EQ(short_text(12.5, 3), "12.5");
  EXPECT_EQ(short_text(-0.0001, 3), "0");
  EXPECT_EQ(short_text(100, 0), "100");
}

}  // namespace
}  // namespace bodyscan
