#include "pipeline/pattern/sequence.hpp"

#include <algorithm>
#include <bit>
#include <set>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

Pattern phase(Axis axis, int period_px, int step, int steps) {
  return {.kind = PatternKind::phase, .axis = axis, .period_px = period_px, .step = step, .steps = steps};
}

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

TEST(FastSequence, StartsWithThePhaseStepsOfAnAxisAndKeepsTheCoarseBits) {
  const PatternSequence sequence = make_sequence({1024, 768}, fast_sequence).value();
  ASSERT_EQ(sequence.patterns.size(), 15U);
  EXPECT_EQ(sequence.patterns[1].kind, PatternKind::black);
  for (int step = 0; step < 5; ++step)
    EXPECT_EQ(sequence.patterns[static_cast<std::size_t>(2 + step)], phase(Axis::row, 5, step, 5));
  for (int bit = 9; bit >= 2; --bit)
    EXPECT_EQ(sequence.patterns[static_cast<std::size_t>(16 - bit)],
              (Pattern{PatternKind::gray, Axis::row, bit, false}));
}

TEST(FastSequence, HasNoInversesAndTakesBothAxes) {
  const PatternSequence sequence =
      make_sequence({1024, 600}, {.columns = true, .inverses = true, .phase = PhaseCode{}}).value();
  ASSERT_EQ(sequence.patterns.size(), 28U);
  EXPECT_EQ(sequence.patterns[15], phase(Axis::column, 5, 0, 5));
  EXPECT_TRUE(std::ranges::none_of(sequence.patterns, &Pattern::inverted));
}

TEST(FastSequence, RefusesCodesThatCannotBeToldApart) {
  const auto refused = [](const PhaseCode& code, Size projector = {1024, 768}) {
    const auto sequence = make_sequence(projector, {.phase = code});
    return !sequence && sequence.error().kind == ErrorKind::usage;
  };
  EXPECT_FALSE(refused({.period_px = 4, .steps = 4, .finest_bit = 1}));
  EXPECT_FALSE(refused({.period_px = 64, .steps = 4, .finest_bit = 2}));
  EXPECT_TRUE(refused({.period_px = 4, .steps = 4, .finest_bit = 2}));  // a cell is a period
  EXPECT_TRUE(refused({.period_px = 5, .steps = 4, .finest_bit = 2}));
  EXPECT_TRUE(refused({.period_px = 6, .steps = 2, .finest_bit = 2}));
  EXPECT_TRUE(refused({.period_px = 65, .steps = 5, .finest_bit = 2}));
  EXPECT_TRUE(refused({.period_px = 16, .steps = 4, .finest_bit = 3}));
  EXPECT_TRUE(refused({.period_px = 16, .steps = 4, .finest_bit = -1}));
  EXPECT_TRUE(refused({.period_px = 0, .steps = 0, .finest_bit = 2}));
  EXPECT_TRUE(refused({}, {1024, 8}));
  EXPECT_FALSE(refused({}, {1024, 9}));
}

TEST(FastSequence, EveryRowHasItsOwnCode) {
  const PatternSequence sequence = make_sequence({4, 768}, fast_sequence).value();
  std::set<unsigned> codes;
  for (unsigned row = 0; row < 768; ++row) {
    unsigned code = 0;
    for (const Pattern& pattern : sequence.patterns)
      if (pattern.kind == PatternKind::gray || pattern.kind == PatternKind::phase)
        code = 2 * code + (pattern_is_white(pattern, row) ? 1 : 0);
    codes.insert(code);
  }
  EXPECT_EQ(codes.size(), 768U);
}

TEST(RenderPattern, ShiftsThePhasesStripesByAStep) {
  const int step_0[] = {255, 255, 0, 0, 0, 255, 255, 0};
  const int step_1[] = {0, 255, 255, 0, 0, 0, 255, 255};
  const int step_4[] = {255, 0, 0, 0, 255, 255, 0, 0};
  const GrayImage8 rows = render_pattern(phase(Axis::row, 5, 1, 5), {3, 8});
  const GrayImage8 columns = render_pattern(phase(Axis::column, 5, 4, 5), {8, 3});
  const GrayImage8 unshifted = render_pattern(phase(Axis::row, 5, 0, 5), {3, 8});
  const GrayImage8 wide = render_pattern(phase(Axis::row, 8, 1, 4), {3, 8});
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_EQ(unshifted(j, i), step_0[i]);
      EXPECT_EQ(rows(j, i), step_1[i]);
      EXPECT_EQ(columns(i, j), step_4[i]);
      EXPECT_EQ(wide(j, i), i >= 2 && i < 6 ? 255 : 0);
    }
  }
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
  EXPECT_EQ(describe(phase(Axis::row, 5, 3, 5)), "phase row step 3 of 5 (period 5)");
}

}  // namespace
}  // namespace bodyscan
