#include "tools/simulator/serve/wall_light.hpp"

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

using std::chrono::milliseconds;

const Moment start = Moment() + std::chrono::hours(1);

Moment at(int ms) {
  return start + milliseconds(ms);
}

Picture uniform(std::uint8_t code) {
  return make_picture(GrayImage8({4, 4}, code));
}

double share(const LightMix& mix, const Picture& picture) {
  for (const PictureShare& part : mix) {
    if (part.picture->key == picture->key) return part.share;
  }
  return 0;
}

class WallLightTest : public testing::Test {
 protected:
  Picture black_ = uniform(0);
  Picture white_ = uniform(255);
  Picture gray_ = uniform(128);
  WallLight light_{black_, milliseconds(30), milliseconds(20)};
};

TEST_F(WallLightTest, PicturesAreToldApartByTheirContent) {
  EXPECT_EQ(uniform(7)->key, uniform(7)->key);
  EXPECT_NE(uniform(7)->key, uniform(8)->key);
}

TEST_F(WallLightTest, AFlipShowsAfterTheLatencyAndSettlesAfterTheRise) {
  light_.show(white_, at(0));
  EXPECT_EQ(share(light_.mean(at(0), at(30)), white_), 0);
  EXPECT_NEAR(share(light_.mean(at(40), at(40)), white_), 0.5, 1e-9);
  const LightMix settled = light_.mean(at(50), at(100));
  ASSERT_EQ(settled.size(), 1U);
  EXPECT_EQ(settled[0].picture->key, white_->key);
  EXPECT_EQ(settled[0].share, 1);
}

TEST_F(WallLightTest, AnExposureAveragesTheRise) {
  light_.show(white_, at(0));
  EXPECT_NEAR(share(light_.mean(at(30), at(50)), white_), 0.5, 1e-9);
  // 10 ms black, 20 ms rising, 20 ms white.
  const LightMix mix = light_.mean(at(20), at(70));
  EXPECT_NEAR(share(mix, white_), 30.0 / 50, 1e-9);
  EXPECT_NEAR(share(mix, black_), 20.0 / 50, 1e-9);
  // The rise's first quarter: from 0 to 1/4.
  EXPECT_NEAR(share(light_.mean(at(30), at(35)), white_), 0.125, 1e-9);
}

TEST_F(WallLightTest, AFlipDuringARiseStartsFromWhatIsThere) {
  light_.show(white_, at(0));
  light_.show(gray_, at(10));  // begins at 40, when white is half on
  const LightMix mix = light_.mean(at(50), at(50));
  EXPECT_NEAR(share(mix, gray_), 0.5, 1e-9);
  EXPECT_NEAR(share(mix, white_), 0.25, 1e-9);
  EXPECT_NEAR(share(mix, black_), 0.25, 1e-9);
  EXPECT_EQ(light_.mean(at(60), at(70)).size(), 1U);
}

TEST_F(WallLightTest, WithoutRiseAFlipIsASwitch) {
  WallLight light(black_, milliseconds(0), milliseconds(0));
  light.show(white_, at(10));
  EXPECT_EQ(share(light.mean(at(9), at(9)), white_), 0);
  EXPECT_EQ(share(light.mean(at(10), at(10)), white_), 1);
  EXPECT_NEAR(share(light.mean(at(0), at(40)), white_), 0.75, 1e-9);
}

TEST_F(WallLightTest, ForgettingChangesNothingLater) {
  light_.show(white_, at(0));
  light_.show(gray_, at(10));
  light_.show(black_, at(100));
  const double before = share(light_.mean(at(45), at(140)), gray_);
  light_.forget_before(at(45));
  EXPECT_EQ(share(light_.mean(at(45), at(140)), gray_), before);
  light_.forget_before(at(1000));
  EXPECT_EQ(share(light_.mean(at(1000), at(1010)), black_), 1);
}

}  // namespace
}  // namespace bodyscan::simulator
