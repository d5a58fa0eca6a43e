#include "pipeline/base/median.hpp"

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

TEST(Median, IsTheMiddleOfAnOddNumber) {
  EXPECT_EQ(median(std::vector<double>{3, 1, 2}), 2);
  EXPECT_EQ(median(std::vector<float>{7}), 7);
}

TEST(Median, IsTheMeanOfBothMiddlesOfAnEvenNumber) {
  EXPECT_EQ(median(std::vector<double>{4, 1, 2, 3}), 2.5);
  EXPECT_EQ(median(std::vector<double>{5, -5}), 0);
}

TEST(Median, OfNothingIsZero) {
  EXPECT_EQ(median(std::vector<double>{}), 0);
}

}  // namespace
}  // namespace bodyscan
