#include "app/scan/light_guard.hpp"

#include "hal/clock.hpp"
#include "tests/app/scan/world.hpp"

#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

using namespace std::chrono_literals;

class LightGuardTest : public testing::Test {
 protected:
  static GrayImage8 filled(std::uint8_t value) { return {world_calibration().projector.size, value}; }

  // How long the projector stays lit, at most a second.
  std::chrono::milliseconds time_until_dark() {
    const std::int64_t begin = monotonic_us();
    while (projector_.lit() && monotonic_us() < begin + 1'000'000) std::this_thread::sleep_for(1ms);
    return std::chrono::milliseconds((monotonic_us() - begin) / 1000);
  }

  FakeProjector projector_;
  std::atomic<bool> stopped_ = false;
  std::function<Expected<void>()> stop_ = [this]() -> Expected<void> {
    if (stopped_) return tl::unexpected(Error{ErrorKind::usage, "interrupted"});
    return {};
  };
};

TEST_F(LightGuardTest, DarkensWithin100MsOfTheStopAndShowsNothingMore) {
  LightGuard light(projector_, 60, stop_);
  ASSERT_TRUE(light.open());
  ASSERT_TRUE(light.show(filled(255)));
  EXPECT_TRUE(projector_.lit());
  stopped_ = true;
  EXPECT_LT(time_until_dark(), 100ms);
  const Expected<std::int64_t> shown = light.show(filled(255));
  ASSERT_FALSE(shown);
  EXPECT_EQ(shown.error().message, "interrupted");
  EXPECT_FALSE(projector_.lit());
  EXPECT_FALSE(light.check());
  EXPECT_FALSE(light.open());
}

TEST_F(LightGuardTest, IsDarkAtItsEnd) {
  {
    LightGuard light(projector_, 60, stop_);
    ASSERT_TRUE(light.open());
    ASSERT_TRUE(light.show(filled(1)));
    EXPECT_TRUE(projector_.lit());
  }
  EXPECT_FALSE(projector_.lit());
  EXPECT_FALSE(projector_.is_open());
}

TEST_F(LightGuardTest, TooMuchLightIsAQualityErrorAndDark) {
  LightGuard light(projector_, 0.05, stop_);
  ASSERT_TRUE(light.open());
  ASSERT_TRUE(light.show(filled(255)));
  EXPECT_LT(time_until_dark(), 150ms);
  const Expected<void> outcome = light.check();
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().kind, ErrorKind::quality);
  EXPECT_FALSE(light.show(filled(255)));
  EXPECT_FALSE(projector_.lit());
}

TEST_F(LightGuardTest, CountsOnlyTheTimeThatItIsLit) {
  LightGuard light(projector_, 60, stop_);
  ASSERT_TRUE(light.open());
  std::this_thread::sleep_for(200ms);
  ASSERT_TRUE(light.show(filled(0)));
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(light.light_s(), 0);
  const std::int64_t begin = monotonic_us();
  ASSERT_TRUE(light.show(filled(255)));
  std::this_thread::sleep_for(50ms);
  ASSERT_TRUE(light.show(filled(128)));
  std::this_thread::sleep_for(50ms);
  ASSERT_TRUE(light.darken());
  const double lit_s = static_cast<double>(monotonic_us() - begin) * 1e-6;
  std::this_thread::sleep_for(200ms);
  EXPECT_GE(light.light_s(), 0.1);
  EXPECT_LE(light.light_s(), lit_s);
}

TEST_F(LightGuardTest, AStopEndsWaiting) {
  LightGuard light(projector_, 60, stop_);
  ASSERT_TRUE(light.open());
  const std::int64_t begin = monotonic_us();
  EXPECT_TRUE(light.wait_until(begin + 30'000));
  EXPECT_GE(monotonic_us(), begin + 30'000);
  stopped_ = true;
  EXPECT_FALSE(light.wait_until(begin + 10'000'000));
  EXPECT_LT(monotonic_us(), begin + 1'000'000);
}

// A projector that was replugged is dark until the next pattern.
TEST_F(LightGuardTest, OpeningAgainEndsTheLight) {
  LightGuard light(projector_, 60, stop_);
  ASSERT_TRUE(light.open());
  ASSERT_TRUE(light.show(filled(255)));
  ASSERT_TRUE(light.open());
  const double lit_s = light.light_s();
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(light.light_s(), lit_s);
}

}  // namespace
}  // namespace bodyscan
