#include "pipeline/capture_check/frame_check.hpp"

#include "tests/pipeline/capture_check/photographed_texture.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

// "reason, again: 3 4"; "accepted".
std::string told(const std::optional<FrameFault>& fault) {
  if (!fault) return "accepted";
  std::string text = fault->reason + ", again:";
  for (const int index : fault->again) text += ' ' + std::to_string(index);
  return text;
}

const std::string same_again = "the same picture as the shot before, again: ";
const std::string exposed_otherwise = "another exposure than white's and black's, again: ";

class FrameCheckTest : public testing::TestWithParam<bool> {
 protected:
  [[nodiscard]] Luma shoot(int index, const ShotOptions& options = {}) {
    return wall_.shoot(patterns_.at(static_cast<std::size_t>(index)), options);
  }

  // Every photograph before `index`, accepted.
  void accept_until(int index, const ShotOptions& options = {}) {
    check_ = FrameCheck(patterns_);
    for (int i = 0; i < index; ++i) ASSERT_EQ(told(check_.check(i, shoot(i, options))), "accepted") << i;
  }

  [[nodiscard]] int count() const { return static_cast<int>(patterns_.size()); }

  TexturedWall wall_;
  const bool inverses_ = GetParam();
  const std::vector<Pattern> patterns_ = patterns_of_wall(inverses_);
  FrameCheck check_{patterns_};
};

INSTANTIATE_TEST_SUITE_P(Inverses, FrameCheckTest, testing::Bool());

TEST_P(FrameCheckTest, AcceptsANoisySequence) {
  accept_until(count());
  accept_until(count(), {.ambient = 0.1, .noise = 2});
  accept_until(count(), {.exposure = 0.3});
}

TEST_P(FrameCheckTest, AcceptsStripesTooFineForTheCamera) {
  for (const int bits : {1, 2}) accept_until(count(), {.noise = 0.5, .blurred_bits = bits});
}

TEST_P(FrameCheckTest, RefusesTheVeryPictureOfTheShotBefore) {
  Luma before = shoot(0);
  ASSERT_EQ(told(check_.check(0, before)), "accepted");
  for (int index = 1; index < count(); ++index) {
    EXPECT_EQ(told(check_.check(index, before)), same_again + std::to_string(index));
    before = shoot(index);
    EXPECT_EQ(told(check_.check(index, before)), "accepted") << index;
  }
}

// What the first photograph of a sequence shows that lags by one, from any pattern on.
TEST_P(FrameCheckTest, RefusesTheShotBeforeWithNoiseOfItsOwn) {
  accept_until(2);
  for (int index = 2; index < count(); ++index) {
    EXPECT_EQ(told(check_.check(index, shoot(index - 1))), same_again + std::to_string(index));
    EXPECT_EQ(told(check_.check(index, shoot(index))), "accepted") << index;
  }
}

TEST_P(FrameCheckTest, RefusesASequenceThatStartsWithAnEarlierPicture) {
  for (int earlier = 0; earlier < count() - 1; ++earlier) {
    check_ = FrameCheck(patterns_);
    EXPECT_FALSE(check_.check(0, shoot(earlier)));
    EXPECT_TRUE(check_.check(1, shoot(0))) << earlier;
  }
}

TEST_P(FrameCheckTest, ASequenceThatRunsAheadIsNoticedAtItsInverse) {
  if (!inverses_) return;
  accept_until(2);
  for (int start = 2; start < count() - 3; ++start) {
    FrameCheck ahead = check_;
    int index = start;
    while (index < count() - 1 && !ahead.check(index, shoot(index + 1))) ++index;
    EXPECT_LE(index, start + 2) << start;
    ASSERT_EQ(told(check_.check(start, shoot(start))), "accepted") << start;
  }
}

TEST_P(FrameCheckTest, RefusesAnotherExposure) {
  accept_until(2);
  for (int index = 2; index < count(); ++index) {
    EXPECT_EQ(told(check_.check(index, shoot(index, {.exposure = 4}))),
              exposed_otherwise + std::to_string(index));
    EXPECT_EQ(told(check_.check(index, shoot(index))), "accepted") << index;
  }
}

TEST_P(FrameCheckTest, AnInverseMustComplementItsPattern) {
  if (!inverses_) return;
  accept_until(3);
  EXPECT_EQ(told(check_.check(3, shoot(3, {.exposure = 0.25}))),
            "not the complement of its pattern, again: 2 3");
  EXPECT_EQ(told(check_.check(2, shoot(2))), "accepted");
  EXPECT_EQ(told(check_.check(3, shoot(3))), "accepted");
}

TEST_P(FrameCheckTest, WhiteMustBeBrighterThanBlack) {
  EXPECT_FALSE(check_.check(0, shoot(1)));
  EXPECT_EQ(told(check_.check(1, shoot(0))), "white is darker than black, again: 0 1");
  EXPECT_EQ(told(check_.check(0, shoot(0))), "accepted");
  EXPECT_EQ(told(check_.check(1, shoot(1))), "accepted");
}

TEST_P(FrameCheckTest, WithoutLightBlackIsDoubtedFirstAndThenBoth) {
  const std::string reason = "white and black show the same: the projector's light is not seen, again: ";
  const ShotOptions dark{.projector = 0};
  EXPECT_FALSE(check_.check(0, shoot(0, dark)));
  EXPECT_EQ(told(check_.check(1, shoot(1, dark))), reason + "1");
  EXPECT_EQ(told(check_.check(1, shoot(1, dark))), reason + "0 1");
  EXPECT_FALSE(check_.check(0, shoot(0)));
  EXPECT_EQ(told(check_.check(1, shoot(1))), "accepted");
}

TEST_P(FrameCheckTest, WhiteOnceMoreIsNoBlackHoweverNoisy) {
  for (const double noise : {0.3, 1.0, 1.0, 1.0, 3.0, 3.0, 3.0}) {
    check_ = FrameCheck(patterns_);
    EXPECT_FALSE(check_.check(0, shoot(0, {.noise = noise})));
    EXPECT_EQ(told(check_.check(1, shoot(0, {.noise = noise}))),
              "white and black show the same: the projector's light is not seen, again: 1")
        << noise;
    EXPECT_EQ(told(check_.check(1, shoot(1, {.noise = noise}))), "accepted") << noise;
  }
}

TEST_P(FrameCheckTest, RefusesOverExposedPictures) {
  EXPECT_FALSE(check_.check(0, shoot(0, {.exposure = 5})));
  EXPECT_EQ(told(check_.check(1, shoot(1, {.exposure = 5}))), "over-exposed, again: 0 1");
}

TEST_P(FrameCheckTest, APictureThatIsSkippedIsTheShotBefore) {
  accept_until(4);
  const Luma skipped = shoot(4);
  check_.skip(skipped);
  EXPECT_EQ(told(check_.check(4, skipped)), same_again + "4");
  check_.skip(shoot(2));
  EXPECT_EQ(told(check_.check(4, shoot(4))), "accepted");
}

TEST_P(FrameCheckTest, SixteenBitsAreReadAsSuch) {
  for (int index = 0; index < count(); ++index) {
    const GrayImage8 photograph = wall_.shoot(patterns_[static_cast<std::size_t>(index)]);
    GrayImage16 wide(photograph.size());
    std::ranges::transform(photograph.pixels(), wide.pixels().begin(),
                           [](std::uint8_t value) { return static_cast<std::uint16_t>(257 * value); });
    EXPECT_EQ(told(check_.check(index, std::move(wide))), "accepted") << index;
  }
}

}  // namespace
}  // namespace bodyscan
