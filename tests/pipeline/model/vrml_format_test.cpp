#include "pipeline/model/vrml_format.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan::vrml {
namespace {

std::string point_text(const Point3f& point) {
  std::vector<char> out(max_point_bytes);
  return {out.data(), format_points(std::span(&point, 1), out.data()).bytes};
}

std::string face_text(const Face& face) {
  std::vector<char> out(max_face_bytes);
  return {out.data(), format_faces(std::span(&face, 1), 0xFFFFFFFF, out.data()).bytes};
}

TEST(FormatPoints, WritesNoSuperfluousDigits) {
  EXPECT_EQ(point_text({0, -0.0F, 1}), "0 0 1\n");
  EXPECT_EQ(point_text({1000.5F, -0.25F, 0.0625F}), "1000.5 -0.25 0.0625\n");
  EXPECT_EQ(point_text({100000, -100000, 10000}), "100000 -100000 10000\n");
  EXPECT_EQ(point_text({99999.9921875F, 10.01F, -99.099998F}), "99999.9922 10.01 -99.1\n");
}

TEST(FormatPoints, RoundsToATenThousandth) {
  EXPECT_EQ(point_text({0.000051F, 0.000049F, -0.000049F}), "0.0001 0 0\n");
  EXPECT_EQ(point_text({0.03125F, -0.03125F, 39295.53125F}), "0.0313 -0.0313 39295.5313\n");
  EXPECT_EQ(point_text({0.99996F, 9.99996F, -999.99997F}), "1 10 -1000\n");
}

TEST(FormatPoints, AgreesWithToCharsExceptAtExactHalves) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> exponent(-5, 5);
  for (int i = 0; i < 100000; ++i) {
    const float value = std::pow(10.0F, exponent(random)) * (i % 2 == 0 ? 1.0F : -1.0F);
    if (std::fmod(std::abs(static_cast<double>(value)) * 10000, 1) == 0.5) continue;
    char expected[64];
    const auto end =
        std::to_chars(expected, expected + 64, static_cast<double>(value), std::chars_format::fixed, 4);
    std::string fixed(expected, end.ptr);
    fixed.erase(fixed.find_last_not_of('0') + 1);
    if (fixed.back() == '.') fixed.pop_back();
    if (fixed == "-0") fixed = "0";
    const std::string text = point_text({value, 0, 0});
    ASSERT_EQ(text, fixed + " 0 0\n");
  }
}

TEST(FormatPoints, StopsBeforeAPointThatIsNotFiniteOrTooFar) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity(), 100001.0F, -100001.0F}) {
    for (const Point3f& point : {Point3f{bad, 0, 0}, Point3f{0, bad, 0}, Point3f{0, 0, bad}}) {
      const std::vector<Point3f> points = {{1, 2, 3}, point, {4, 5, 6}};
      std::vector<char> out(points.size() * max_point_bytes);
      const Formatted formatted = format_points(points, out.data());
      EXPECT_EQ(formatted.items, 1U);
      EXPECT_EQ(std::string(out.data(), formatted.bytes), "1 2 3\n");
    }
  }
}

TEST(FormatColors, KeepsEveryByteApart) {
  std::vector<Rgb8> colors;
  for (unsigned i = 0; i < 256; ++i) colors.push_back({static_cast<std::uint8_t>(i), 0, 255});
  std::vector<char> out(colors.size() * max_color_bytes);
  const Formatted formatted = format_colors(colors, out.data());
  EXPECT_EQ(formatted.items, 256U);
  const char* next = out.data();
  for (int i = 0; i < 256; ++i) {
    float value = -1;
    const auto parsed = std::from_chars(next, out.data() + formatted.bytes, value);
    ASSERT_EQ(std::lround(value * 255), i);
    ASSERT_NEAR(value, static_cast<float>(i) / 255, 0.000501F);
    ASSERT_EQ(std::string(parsed.ptr, 5), " 0 1\n");
    next = parsed.ptr + 5;
  }
  EXPECT_EQ(next, out.data() + formatted.bytes);
}

TEST(FormatColors, WritesAtMostThreeDecimals) {
  const std::vector<Rgb8> colors = {{0, 51, 255}, {1, 128, 254}};
  std::vector<char> out(colors.size() * max_color_bytes);
  const Formatted formatted = format_colors(colors, out.data());
  EXPECT_EQ(std::string(out.data(), formatted.bytes), "0 0.2 1\n0.004 0.502 0.996\n");
}

TEST(FormatFaces, WritesIndicesOfEveryLength) {
  EXPECT_EQ(face_text({0, 9, 10}), "0 9 10 -1\n");
  EXPECT_EQ(face_text({99, 100, 999}), "99 100 999 -1\n");
  EXPECT_EQ(face_text({1000, 9999, 10000}), "1000 9999 10000 -1\n");
  EXPECT_EQ(face_text({100001, 1000000, 99999999}), "100001 1000000 99999999 -1\n");
  EXPECT_EQ(face_text({100000000, 1000000000, 4294967294}), "100000000 1000000000 4294967294 -1\n");
}

TEST(FormatFaces, StopsBeforeAFaceWithoutItsPoints) {
  const Face good = {0, 1, 2};
  for (const Face& bad :
       {Face{4, 1, 2}, Face{1, 4, 2}, Face{1, 2, 4}, Face{1, 1, 2}, Face{1, 2, 2}, Face{2, 1, 2}}) {
    const std::vector<Face> faces = {good, good, bad, good};
    std::vector<char> out(faces.size() * max_face_bytes);
    const Formatted formatted = format_faces(faces, 4, out.data());
    EXPECT_EQ(formatted.items, 2U);
    EXPECT_EQ(std::string(out.data(), formatted.bytes), "0 1 2 -1\n0 1 2 -1\n");
  }
}

TEST(Quoted, ReplacesWhatReadersTripOver) {
  EXPECT_EQ(quoted("plain \xC3\xA9"), "\"plain \xC3\xA9\"");
  EXPECT_EQ(quoted("a\"b\\c"), "\"a'b/c\"");
  EXPECT_EQ(quoted("a\nb\tc\x7F"), "\"a b c \"");
  EXPECT_EQ(quoted("\xFFg\xC3"), "\"?g?\"");
  EXPECT_EQ(quoted("\xC0\xAF \xED\xA0\x80 \xF4\x90\x80\x80"), "\"?? ??? ????\"");
  EXPECT_EQ(quoted("\xE2\x82\xAC\xF0\x9F\x98\x80"), "\"\xE2\x82\xAC\xF0\x9F\x98\x80\"");
}

}  // namespace
}  // namespace bodyscan::vrml
