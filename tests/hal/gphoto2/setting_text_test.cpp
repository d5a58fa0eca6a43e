#include "hal/gphoto2/setting_text.hpp"

#include <utility>

#include <gtest/gtest.h>

namespace bodyscan::gphoto2 {
namespace {

TEST(SettingText, ExposureTimesOfAllMakes) {
  const std::vector<std::pair<const char*, double>> texts = {
      {"1/20", 0.05}, {"1/20s", 0.05}, {"0.0500s", 0.05},   {"0.05s", 0.05},       {"2", 2},
      {"30s", 30},    {"0.3", 0.3},    {"10/13", 10. / 13}, {"1/4000", 1. / 4000}, {"1/20 s", 0.05},
  };
  for (const auto& [text, seconds] : texts) {
    const auto parsed = exposure_seconds(text);
    ASSERT_TRUE(parsed) << text;
    EXPECT_DOUBLE_EQ(*parsed, seconds) << text;
  }
}

TEST(SettingText, WhatIsNoExposureTime) {
  for (const char* text : {"", "s", "Bulb", "Time", "x 200", "1/0", "0", "-1", "1/", "/20", "1/20/3", "0x10",
                           "nan", "inf", "1e3", "1e999", "1/1e400", "1/20ss", "Unknown value 1234"})
    EXPECT_FALSE(exposure_seconds(text)) << text;
}

TEST(SettingText, FNumbers) {
  EXPECT_EQ(f_number("f/8"), 8);
  EXPECT_EQ(f_number("f/3.8"), 3.8);
  EXPECT_EQ(f_number("F5.6"), 5.6);
  EXPECT_EQ(f_number("11"), 11);
  for (const char* text : {"", "f/", "f/0", "implicit auto", "--"}) EXPECT_FALSE(f_number(text)) << text;
}

TEST(SettingText, SensitivityAndCharge) {
  EXPECT_EQ(iso("200"), 200);
  for (const char* text : {"Auto", "Lo 1", "200 (auto)"}) EXPECT_FALSE(iso(text)) << text;
  EXPECT_EQ(percent("87%"), 87);
  EXPECT_EQ(percent("0%"), 0);
  for (const char* text : {"87", "%", "full"}) EXPECT_FALSE(percent(text)) << text;
}

TEST(SettingText, PictureSizes) {
  EXPECT_EQ(picture_size("4288x2848"), (Size{4288, 2848}));
  for (const char* text :
       {"", "x", "4288", "0x2848", "4288x", "-1x5", "Large", "4288x2848x1", "999999x1", "99999999999x1"})
    EXPECT_FALSE(picture_size(text)) << text;
}

TEST(SettingText, TheNearestExposureIsNearestAsARatio) {
  const std::vector<std::string> choices = {"Bulb", "1/60", "1/30", "1/15", "1", "30"};
  const auto nearest = [&](double seconds) { return nearest_choice(choices, seconds, exposure_seconds); };
  EXPECT_EQ(nearest(1. / 30), "1/30");
  EXPECT_EQ(nearest(0.05), "1/15");
  EXPECT_EQ(nearest(0.047), "1/30");
  EXPECT_EQ(nearest(1e-6), "1/60");
  EXPECT_EQ(nearest(1000), "30");
  EXPECT_FALSE(nearest_choice({"Bulb", "Auto"}, 1, exposure_seconds));
  EXPECT_FALSE(nearest_choice({}, 1, exposure_seconds));
}

TEST(SettingText, TheBestJpegOfEachMake) {
  EXPECT_EQ(best_jpeg({"JPEG Basic", "JPEG Normal", "JPEG Fine", "NEF (Raw)", "NEF+Basic", "NEF+Fine"}),
            "JPEG Fine");
  EXPECT_EQ(best_jpeg({"JPEG Fine", "JPEG Fine*", "TIFF (RGB)", "JPEG Normal*"}), "JPEG Fine*");
  EXPECT_EQ(best_jpeg({"RAW", "Smaller JPEG", "Large Normal JPEG", "Medium Fine JPEG", "Large Fine JPEG",
                       "RAW + Large Fine JPEG"}),
            "Large Fine JPEG");
  EXPECT_EQ(best_jpeg({"Standard", "Fine", "Extra Fine", "RAW", "RAW+JPEG (Std)"}), "Extra Fine");
  EXPECT_FALSE(best_jpeg({"NEF (Raw)", "Unknown"}));
  EXPECT_FALSE(best_jpeg({}));
}

}  // namespace
}  // namespace bodyscan::gphoto2
