#include "tools/simulator/serve/ptp/property.hpp"

#include <gtest/gtest.h>

namespace bodyscan::simulator::ptp {
namespace {

TEST(PtpProperty, AnEnumerationListsItsChoices) {
  const Property property{
      PropertyCode::f_number, std::uint16_t{800}, true, {std::uint16_t{560}, std::uint16_t{800}}};
  EXPECT_EQ(describe(property, std::uint16_t{560}), (Bytes{0x07, 0x50, 4, 0, 1,     // code, type, writable
                                                           0x30, 0x02, 0x20, 0x03,  // factory, current
                                                           2, 2, 0, 0x30, 0x02, 0x20, 0x03}));
}

TEST(PtpProperty, ARangeHasLeastMostAndStep) {
  const Property property{PropertyCode::battery_level,
                          std::uint8_t{87},
                          false,
                          {},
                          Property::Range{std::uint8_t{0}, std::uint8_t{100}, std::uint8_t{1}}};
  EXPECT_EQ(describe(property, std::uint8_t{87}), (Bytes{0x01, 0x50, 2, 0, 0, 87, 87, 1, 0, 100, 1}));
}

TEST(PtpProperty, WithoutLimitsTheFormIsNone) {
  const Property property{PropertyCode::date_time, std::string("x"), true};
  EXPECT_EQ(describe(property, std::string("x")),
            (Bytes{0x11, 0x50, 0xFF, 0xFF, 1, 2, 'x', 0, 0, 0, 2, 'x', 0, 0, 0, 0}));
}

TEST(PtpProperty, ValuesOfEveryTypeSurviveTheWire) {
  for (const Value& value :
       {Value{std::int8_t{-5}}, Value{std::uint8_t{200}}, Value{std::int16_t{-5000}},
        Value{std::uint16_t{0x8010}}, Value{std::uint32_t{0x00010014}}, Value{std::string("429x285")}}) {
    const Bytes bytes = encode(value);
    EXPECT_EQ(decode(bytes, value), value);
    EXPECT_EQ(decode(std::span(bytes).first(bytes.size() - 1), value), std::nullopt);
  }
}

TEST(PtpProperty, AllowsItsChoicesOrItsRangeOnly) {
  const Property choices{PropertyCode::f_number, std::uint16_t{800}, true, {std::uint16_t{800}}};
  EXPECT_TRUE(allows(choices, std::uint16_t{800}));
  EXPECT_FALSE(allows(choices, std::uint16_t{801}));
  const Property range{PropertyCode::burst_number,
                       std::uint16_t{1},
                       true,
                       {},
                       Property::Range{std::uint16_t{1}, std::uint16_t{99}, std::uint16_t{1}}};
  EXPECT_TRUE(allows(range, std::uint16_t{99}));
  EXPECT_FALSE(allows(range, std::uint16_t{100}));
  EXPECT_FALSE(allows(range, std::uint16_t{0}));
}

}  // namespace
}  // namespace bodyscan::simulator::ptp
