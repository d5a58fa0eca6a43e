#include "pipeline/pattern/sequence.hpp"

#include <algorithm>
#include <bit>
#include <set>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

TEST(GrayCode, NeighboursDifferInOneBit) {
  for (unsigned i = 0; i + 1 < 4096; ++i) EXPECT_EQ(std::popcount(gray_code(i) ^ gray_code(i + 1)), 1);
}

TEST(GrayCode, BitsAreTheLogarithmRoundedUp) {
  EXPECT_EQ(gray_bits(1), 0);
  EXPECT_EQ(gray_bits(2), 1);
  EXPECT_EQ(gray_bits(3), 2);
  EXPECT_EQ(gray_bits(768), 10);
  EXPECT_EQ(gray_bits(1024), 10);
  EXPECT_EQ(gray_bits(1025), 11);
}

TEST(PatternSequence, ThesisOrderIsTheDefault) {
  const PatternSequence sequence = make_sequence({1024, 768}).value();
  ASSERT_EQ(sequence.patterns.size(), 22U);
  EXPECT_EQ(sequence.patterns[0].kind, PatternKind::white);
  EXPECT_EQ(sequence.patterns[1].kind, PatternKind::black);
  EXPECT_EQ(sequence.patterns[2], (Pattern{PatternKind::gray, Axis::row, 9, false}));
  EXPECT_EQ(sequence.patterns[3], (Pattern{PatternKind::gray, Axis::row, 9, true}));
  EXPECT_EQ(sequence.patterns[21], (Pattern{PatternKind::gray, Axis::row, 0, true}));
}

TEST(PatternSequence, BothAxesAndNoInverses) {
  const PatternSequence sequence =
      make_sequence({800, 600}, {.rows = true, .columns = true, .inverses = false}).value();
  ASSERT_EQ(sequence.patterns.size(), 22U);
  EXPECT_EQ(sequence.patterns[11], (Pattern{PatternKind::gray, Axis::row, 0, false}));
  EXPECT_EQ(sequence.patterns[12], (Pattern{PatternKind::gray, Axis::column, 9, false}));
}

TEST(PatternSequence, RefusesWhatCannotBeCoded) {
  for (const Size size : {Size{1, 768}, Size{1024, 0}, Size{-5, 5}, Size{32769, 768}}) {
    const auto sequence = make_sequence(size);
    ASSERT_FALSE(sequence);
    EXPECT_EQ(sequence.error().kind, ErrorKind::usage);
  }
  EXPECT_FALSE(make_sequence({1024, 768}, {.rows = false}));
}

TEST(PatternSequence, EveryRowHasItsOwnCode) {
  const PatternSequence sequence = make_sequence({4, 768}, {.inverses = false}).value();
  std::set<unsigned> codes;
  for (unsigned row = 0; row < 768; ++row) {
    unsigned code = 0;
    for (const Pattern& pattern : sequence.patterns)
      if (pattern.kind == PatternKind::gray) code = 2 * code + (pattern_is_white(pattern, row) ? 1 : 0);
    EXPECT_EQ(code, row ^ (row >> 1));
    codes.insert(code);
  }
  EXPECT_EQ(codes.size(), 768U);
}

TEST(RenderPattern, ShowsTheBitOfItsRowOrColumn) {
  const GrayImage8 rows = render_pattern({PatternKind::gray, Axis::row, 1, false}, {3, 8});
  const GrayImage8 inverse = render_pattern({PatternKind::gray, Axis::row, 1, true}, {3, 8});
  const GrayImage8 columns = render_pattern({PatternKind::gray, Axis::column, 0, false}, {8, 3});
  // g(0..7) = 0 1 3 2 6 7 5 4
  const int bit_1[] = {0, 0, 255, 255, 255, 255, 0, 0};
  const int bit_0[] = {0, 255, 255, 0, 0, 255, 255, 0};
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_EQ(rows(j, i), bit_1[i]);
      EXPECT_EQ(inverse(j, i), 255 - bit_1[i]);
      EXPECT_EQ(columns(i, j), bit_0[i]);
    }
  }
}

TEST(RenderPattern, WhiteAndBlackAreUniform) {
  const GrayImage8 white = render_pattern({.kind = PatternKind::white}, {5, 4});
  const GrayImage8 black = render_pattern({.kind = PatternKind::black}, {5, 4});
  EXPECT_EQ(std::ranges::count(white.pixels(), 255), 20);
  EXPECT_EQ(std::ranges::count(black.pixels(), 0), 20);
}

TEST(Pattern, DescribesItself) {
  EXPECT_EQ(describe({.kind = PatternKind::black}), "black");
  EXPECT_EQ(describe({PatternKind::gray, Axis::column, 3, true}), "gray column bit 3 inverted");
}

}  // namespace
}  // namespace bodyscan
