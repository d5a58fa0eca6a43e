#include "app/scan/shot_list.hpp"

#include <chrono>
#include <future>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

using namespace std::chrono_literals;

// Takes what there is, in order; nothing of it is judged.
std::vector<PlannedShot> take_all(ShotList& list) {
  std::vector<PlannedShot> shots;
  while (const auto shot = list.next_without_waiting()) shots.push_back(*shot);
  return shots;
}

std::vector<int> patterns_of(const std::vector<PlannedShot>& shots) {
  std::vector<int> patterns;
  for (const PlannedShot& shot : shots) patterns.push_back(shot.pattern);
  return patterns;
}

TEST(ShotList, GivesThePatternsInOrderAndEndsOnceAllAreAccepted) {
  ShotList list(3, 3);
  for (int pattern = 0; pattern < 3; ++pattern) {
    const auto shot = list.next();
    ASSERT_TRUE(shot);
    EXPECT_EQ(shot->pattern, pattern);
    EXPECT_FALSE(shot->discard_first);
    list.accept();
  }
  EXPECT_FALSE(list.next());
  EXPECT_TRUE(list.outcome());
  EXPECT_TRUE(list.refusals().empty());
}

TEST(ShotList, GivesOnlyThePatternsWanted) {
  ShotList list({2, 3, 6}, 7, 3);
  EXPECT_EQ(patterns_of(take_all(list)), (std::vector{2, 3, 6}));
}

TEST(ShotList, RefusedPatternsComeFirstAgainAfterOnePictureThatIsThrownAway) {
  ShotList list(5, 3);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(list.next());
  list.accept();
  list.accept();
  list.refuse(2, {1, 2}, "no complement");
  const std::vector<PlannedShot> shots = take_all(list);
  EXPECT_EQ(patterns_of(shots), (std::vector{1, 2, 3, 4}));
  EXPECT_TRUE(shots[0].discard_first);
  for (std::size_t i = 1; i < shots.size(); ++i) EXPECT_FALSE(shots[i].discard_first) << i;
  EXPECT_EQ(list.refusals(), std::vector<std::string>{"pattern 2: no complement"});
}

TEST(ShotList, FailsOnceAPatternWasRefusedAsOftenAsThereAreAttempts) {
  ShotList list(2, 3);
  for (int attempt = 0; attempt < 3; ++attempt) {
    const auto shot = list.next();
    ASSERT_TRUE(shot) << attempt;
    EXPECT_EQ(shot->pattern, 0);
    EXPECT_TRUE(list.outcome()) << attempt;
    list.refuse(0, {0}, "dark");
  }
  EXPECT_FALSE(list.next());
  const Expected<void> outcome = list.outcome();
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().kind, ErrorKind::device);
  EXPECT_EQ(outcome.error().message, "camera: pattern 0 was shot 3 times in vain: dark");
}

TEST(ShotList, AShotTakenBeforeARefusalIsOutdated) {
  ShotList list(4, 3);
  const auto first = list.next();
  const auto second = list.next();
  ASSERT_TRUE(first && second);
  EXPECT_FALSE(list.outdated(*second));
  list.refuse(0, {0}, "stale");
  EXPECT_TRUE(list.outdated(*second));
  const auto again = list.next();
  ASSERT_TRUE(again);
  EXPECT_FALSE(list.outdated(*again));
}

TEST(ShotList, AShotPutBackComesAgain) {
  ShotList list(3, 3);
  const auto first = list.next();
  const auto second = list.next();
  ASSERT_TRUE(first && second);
  list.put_back(*second);
  EXPECT_EQ(patterns_of(take_all(list)), (std::vector{1, 2}));
}

// The camera is out of step until one picture was thrown away: whichever shot is the first has to.
TEST(ShotList, AShotPutBackDoesNotOvertakeARefusedOne) {
  ShotList list(5, 3);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(list.next());
  list.accept();
  list.refuse(1, {0, 1}, "over-exposed");
  list.put_back({2, false, 0});
  const std::vector<PlannedShot> shots = take_all(list);
  EXPECT_EQ(patterns_of(shots), (std::vector{0, 1, 2, 3, 4}));
  EXPECT_TRUE(shots[0].discard_first);
}

TEST(ShotList, AShotPutBackBeforeARefusedOneThrowsAPictureAway) {
  ShotList list(4, 3);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(list.next());
  list.refuse(2, {2}, "stale");
  list.put_back({1, false, 0});
  const std::vector<PlannedShot> shots = take_all(list);
  EXPECT_EQ(patterns_of(shots), (std::vector{1, 2, 3}));
  EXPECT_TRUE(shots[0].discard_first);
}

TEST(ShotList, NextWaitsForJudgements) {
  using Waiting = std::future<std::optional<PlannedShot>>;
  const auto wait = [](ShotList& list) {
    return std::async(std::launch::async, [&] { return list.next(); });
  };
  const auto take_the_only_one = [](ShotList& list) {
    ASSERT_TRUE(list.next());
    EXPECT_FALSE(list.next_without_waiting());
  };
  {
    ShotList list(1, 3);
    take_the_only_one(list);
    Waiting next = wait(list);
    EXPECT_EQ(next.wait_for(30ms), std::future_status::timeout);
    list.accept();
    EXPECT_FALSE(next.get());
  }
  {
    ShotList list(1, 3);
    take_the_only_one(list);
    Waiting next = wait(list);
    list.refuse(0, {0}, "stale");
    const auto again = next.get();
    ASSERT_TRUE(again);
    EXPECT_EQ(again->pattern, 0);
  }
  {
    ShotList list(1, 3);
    take_the_only_one(list);
    Waiting next = wait(list);
    list.fail({ErrorKind::quality, "nothing lit"});
    EXPECT_FALSE(next.get());
    EXPECT_EQ(list.outcome().error().message, "nothing lit");
  }
}

TEST(ShotList, NothingIsTakenAfterAFailure) {
  ShotList list(3, 3);
  list.fail({ErrorKind::device, "first"});
  list.fail({ErrorKind::device, "second"});
  EXPECT_FALSE(list.next());
  EXPECT_FALSE(list.next_without_waiting());
  EXPECT_EQ(list.outcome().error().message, "first");
}

}  // namespace
}  // namespace bodyscan
