#include "tools/simulator/serve/camera_settings.hpp"

#include <gtest/gtest.h>

namespace bodyscan::simulator {
namespace {

using ptp::PropertyCode;
using ptp::ResponseCode;

constexpr Size picture{2144, 1424};

ptp::ResponseCode set(CameraSettings& settings, PropertyCode code, const ptp::Value& value) {
  return settings.set(code, ptp::encode(value));
}

constexpr std::uint32_t fraction(std::uint32_t numerator, std::uint32_t denominator) {
  return numerator << 16 | denominator;
}

TEST(CameraSettings, StandAt50MsIso200F8) {
  const CameraSettings settings(picture, true);
  EXPECT_EQ(settings.exposure_time(), std::chrono::milliseconds(50));
  EXPECT_EQ(settings.exposure_gain(), 1);
  EXPECT_EQ(settings.value(PropertyCode::exposure_program_mode), ptp::encode(std::uint16_t{1}));
}

TEST(CameraSettings, OfferTheRigsPictureSizeOnly) {
  CameraSettings settings(picture, true);
  EXPECT_EQ(settings.value(PropertyCode::image_size), ptp::encode(std::string("2144x1424")));
  EXPECT_EQ(set(settings, PropertyCode::image_size, std::string("2144x1424")), ResponseCode::ok);
  EXPECT_EQ(set(settings, PropertyCode::image_size, std::string("4288x2848")),
            ResponseCode::invalid_device_prop_value);
}

TEST(CameraSettings, BrightnessFollowsTimeIsoAndAperture) {
  CameraSettings settings(picture, true);
  ASSERT_EQ(set(settings, PropertyCode::nikon_exposure_time, fraction(1, 15)), ResponseCode::ok);
  EXPECT_NEAR(settings.exposure_gain(), 20.0 / 15, 1e-6);
  ASSERT_EQ(set(settings, PropertyCode::exposure_index, std::uint16_t{800}), ResponseCode::ok);
  EXPECT_NEAR(settings.exposure_gain(), 4 * 20.0 / 15, 1e-6);
  ASSERT_EQ(set(settings, PropertyCode::f_number, std::uint16_t{1600}), ResponseCode::ok);
  EXPECT_NEAR(settings.exposure_gain(), 20.0 / 15, 1e-6);
}

TEST(CameraSettings, BothShutterPropertiesShowOneDial) {
  CameraSettings settings(picture, true);
  ASSERT_EQ(set(settings, PropertyCode::nikon_exposure_time, fraction(1, 60)), ResponseCode::ok);
  EXPECT_EQ(settings.value(PropertyCode::exposure_time), ptp::encode(std::uint32_t{166}));
  ASSERT_EQ(set(settings, PropertyCode::exposure_time, std::uint32_t{333}), ResponseCode::ok);
  EXPECT_EQ(settings.value(PropertyCode::nikon_exposure_time), ptp::encode(fraction(1, 30)));
}

TEST(CameraSettings, WrongSettingsAreRefusedAndChangeNothing) {
  CameraSettings settings(picture, true);
  EXPECT_EQ(settings.set(PropertyCode::f_number, ptp::Bytes{0x20}), ResponseCode::invalid_device_prop_format);
  EXPECT_EQ(set(settings, PropertyCode::f_number, std::uint16_t{801}),
            ResponseCode::invalid_device_prop_value);
  EXPECT_EQ(set(settings, PropertyCode::battery_level, std::uint8_t{1}), ResponseCode::access_denied);
  EXPECT_EQ(set(settings, static_cast<PropertyCode>(0x5FFF), std::uint8_t{1}),
            ResponseCode::device_prop_not_supported);
  EXPECT_EQ(settings.value(static_cast<PropertyCode>(0x5FFF)), std::nullopt);
  EXPECT_EQ(settings.description(static_cast<PropertyCode>(0x5FFF)), std::nullopt);
  EXPECT_EQ(settings.exposure_gain(), 1);
}

TEST(CameraSettings, WithTheDialOffManualTheExposureIsTheCameras) {
  CameraSettings settings(picture, false);
  EXPECT_EQ(settings.value(PropertyCode::exposure_program_mode), ptp::encode(std::uint16_t{2}));
  EXPECT_EQ(set(settings, PropertyCode::nikon_exposure_time, fraction(1, 60)), ResponseCode::access_denied);
  EXPECT_EQ(set(settings, PropertyCode::exposure_time, std::uint32_t{166}), ResponseCode::access_denied);
  EXPECT_EQ(set(settings, PropertyCode::f_number, std::uint16_t{1600}), ResponseCode::access_denied);
  EXPECT_EQ(set(settings, PropertyCode::exposure_index, std::uint16_t{400}), ResponseCode::ok);
}

TEST(CameraSettings, EveryPropertyDescribesItself) {
  const CameraSettings settings(picture, true);
  for (const PropertyCode code : settings.codes()) {
    const ptp::Bytes description = settings.description(code).value();
    ptp::DatasetReader reader(description);
    EXPECT_EQ(reader.get<PropertyCode>(), code);
    EXPECT_GT(description.size(), 5 + 2 * settings.value(code)->size());
  }
}

}  // namespace
}  // namespace bodyscan::simulator
