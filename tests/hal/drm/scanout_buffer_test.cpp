#include "hal/drm/scanout_buffer.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

TEST(DrawGray, EveryLevelInEveryColour) {
  GrayImage8 picture({256, 2});
  for (int x = 0; x < 256; ++x) {
    picture(x, 0) = static_cast<std::uint8_t>(x);
    picture(x, 1) = static_cast<std::uint8_t>(255 - x);
  }
  constexpr std::size_t pitch = 256 * 4 + 64;
  std::vector<std::byte> pixels(2 * pitch, std::byte{0xee});
  draw_gray(picture, pixels, pitch);
  for (std::size_t y = 0; y < 2; ++y) {
    for (std::size_t x = 0; x < 256; ++x) {
      const auto level = static_cast<std::byte>(y == 0 ? x : 255 - x);
      const std::byte* pixel = &pixels[y * pitch + 4 * x];
      ASSERT_TRUE(pixel[0] == level && pixel[1] == level && pixel[2] == level) << x << ", " << y;
    }
    EXPECT_EQ(pixels[y * pitch + pitch - 1], std::byte{0xee}) << "padding";
  }
}

}  // namespace
}  // namespace bodyscan
