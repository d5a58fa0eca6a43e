#include "pipeline/capture_check/motion_watch.hpp"

#include "tests/pipeline/capture_check/photographed_texture.hpp"

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

const Eigen::Vector2d jump(2.4, -1.8);  // px
constexpr double jump_px = 3;

// A sequence in which the wall jumps before pattern `jump_at`; -1: never.
SequenceMotion watch(bool inverses, int jump_at) {
  std::vector<Pattern> patterns = patterns_of_wall(inverses);
  TexturedWall wall;
  const Pattern last = patterns.back();
  patterns.pop_back();
  MotionWatch motion(patterns);
  for (int i = 0; i <= static_cast<int>(patterns.size()); ++i) {
    if (i == jump_at) wall.move_to(jump);
    const bool at_end = i == static_cast<int>(patterns.size());
    motion.look(i, wall.shoot(at_end ? last : patterns[static_cast<std::size_t>(i)]));
  }
  return motion.motion();
}

constexpr int pattern_count = 26;  // white, black, 6 rows and 6 columns with inverses

TEST(MotionWatch, AStillSubjectDoesNotMove) {
  const SequenceMotion motion = watch(true, -1);
  EXPECT_LT(motion.largest_px, 0.1);
  ASSERT_EQ(motion.by_pattern_px.size(), pattern_count);
  for (const double px : motion.by_pattern_px) EXPECT_LT(px, 0.1);
}

TEST(MotionWatch, AJumpPartsThePatternsBeforeItFromThoseAfter) {
  for (const int jump_at : {2, 8, 26}) {
    const SequenceMotion motion = watch(true, jump_at);
    EXPECT_NEAR(motion.largest_px, jump_px, 0.15);
    ASSERT_EQ(motion.by_pattern_px.size(), pattern_count);
    for (int i = 0; i < pattern_count; ++i)
      EXPECT_NEAR(motion.by_pattern_px[static_cast<std::size_t>(i)], i < jump_at ? jump_px : 0, 0.15)
          << jump_at << " pattern " << i;
  }
}

TEST(MotionWatch, WithoutInversesOnlyStartAndEndAreKnown) {
  const SequenceMotion moved = watch(false, 5);
  EXPECT_NEAR(moved.largest_px, jump_px, 0.15);
  EXPECT_TRUE(moved.by_pattern_px.empty());
  EXPECT_LT(watch(false, -1).largest_px, 0.1);
}

TEST(MotionWatch, BeforeTheEndNothingIsKnown) {
  TexturedWall wall;
  MotionWatch motion(patterns_of_wall(true));
  EXPECT_EQ(motion.motion().largest_px, 0);
  motion.look(0, wall.shoot({.kind = PatternKind::white}));
  EXPECT_EQ(motion.motion().largest_px, 0);
  EXPECT_TRUE(motion.motion().by_pattern_px.empty());
}

}  // namespace
}  // namespace bodyscan
