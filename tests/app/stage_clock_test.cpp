#include "app/stage_clock.hpp"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

TEST(StageClock, StagesFollowOneAnotherWithoutGaps) {
  using namespace std::chrono_literals;
  const auto begin = std::chrono::steady_clock::now();
  StageClock clock;
  std::this_thread::sleep_for(20ms);
  clock.end_stage("first");
  clock.end_stage("second");
  const double whole_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  ASSERT_EQ(clock.stages_ms().size(), 2U);
  EXPECT_EQ(clock.stages_ms()[0].first, "first");
  EXPECT_EQ(clock.stages_ms()[1].first, "second");
  EXPECT_GE(clock.stages_ms()[0].second, 20);
  EXPECT_GE(clock.stages_ms()[1].second, 0);
  EXPECT_LE(clock.stages_ms()[0].second + clock.stages_ms()[1].second, whole_ms);
}

}  // namespace
}  // namespace bodyscan
