#include "tools/simulator/serve/rendering_darkroom.hpp"

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

RenderOptions small_options() {
  RenderOptions options;
  options.subject = "builtin:staircase";
  options.rig.scale = 1.0 / 32;
  options.rig.projector = {64, 48};
  return options;
}

class RenderingDarkroomTest : public testing::Test {
 protected:
  // What `take` gives once the darkroom's thread has it ready.
  template <class Take>
  auto wait_for(Take take) {
    auto taken = take();
    while (!taken) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      taken = take();
    }
    return taken;
  }

  const std::unique_ptr<World> world_ = World::make(small_options(), {}).value();
  const Picture black_ = make_picture(GrayImage8({64, 48}, 0));
  const Picture white_ = make_picture(GrayImage8({64, 48}, 255));
  const Moment start_ = Moment() + std::chrono::hours(1);
  WallLight light_{black_, {}, {}};
  EventLoop loop_;
  std::vector<int> opened_;
  RenderingDarkroom darkroom_{*world_, light_, loop_, [this](int shot, Moment) { opened_.push_back(shot); }};
};

TEST_F(RenderingDarkroomTest, DevelopsWhatWasOnTheWall) {
  light_.show(white_, start_);
  darkroom_.shutter_opened(1, start_);
  EXPECT_EQ(opened_, std::vector{1});
  darkroom_.develop({1, start_, start_ + std::chrono::milliseconds(50), 1, 0});
  const std::optional<Photo> photo = wait_for([&] { return darkroom_.take_photo(); });
  EXPECT_EQ(*photo->jpeg, *world_->photograph({{white_, 1}}, 1, 0).jpeg);
  EXPECT_FALSE(darkroom_.take_photo());
}

TEST_F(RenderingDarkroomTest, WhatWasPreparedIsThereAtOnce) {
  darkroom_.prepare(black_, 1, 0);
  darkroom_.develop({1, start_, start_ + std::chrono::milliseconds(50), 1, 0});
  EXPECT_TRUE(darkroom_.take_photo());
  darkroom_.develop({1, start_, start_ + std::chrono::milliseconds(50), 2, 0});
  EXPECT_TRUE(wait_for([&] { return darkroom_.take_photo(); }));
  darkroom_.develop({1, start_, start_ + std::chrono::milliseconds(50), 2, 0});
  EXPECT_TRUE(darkroom_.take_photo());
}

TEST_F(RenderingDarkroomTest, AnExposureThatIsGivenUpDeliversNothing) {
  light_.show(white_, start_);
  darkroom_.prepare(white_, 1, 0);
  darkroom_.develop({1, start_ - std::chrono::milliseconds(50), start_, 1, 0});  // black: not prepared
  darkroom_.develop({2, start_, start_ + std::chrono::milliseconds(50), 1, 0});
  EXPECT_EQ(*darkroom_.take_photo()->jpeg, *world_->photograph({{white_, 1}}, 1, 0).jpeg);
  darkroom_.develop_preview({2, start_, start_, 1, 0});
  EXPECT_TRUE(wait_for([&] { return darkroom_.take_preview(); }));  // behind the given-up one
  EXPECT_FALSE(darkroom_.take_photo());
}

}  // namespace
}  // namespace bodyscan::simulator
