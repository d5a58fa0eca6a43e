#include "pipeline/image/codec.hpp"
#include "tests/pipeline/image/image_fixtures.hpp"

#include <cstdlib>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "\"" << text << "\" does not hold \"" << part << "\"";
}

constexpr Size odd{37, 23};

GrayImage8 luma8(const std::vector<std::byte>& file) {
  Expected<Luma> luma = decode_luma(file);
  EXPECT_TRUE(luma) << luma.error().message;
  return luma ? std::get<GrayImage8>(std::move(*luma)) : GrayImage8(odd, 0);
}

bool equal(const GrayImage8& a, const GrayImage8& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size().area()) == 0;
}

TEST(JpegDecoder, LumaIsTheWeightedSumOfTheChannels) {
  const ColorImage8 image = colorful(odd);
  const GrayImage8 luma = luma8(make_jpeg(image, {.quality = 100}));
  ASSERT_EQ(luma.size(), odd);
  for (int y = 0; y < odd.height; ++y) {
    for (int x = 0; x < odd.width; ++x) {
      const auto [r, g, b] = image(x, y);
      ASSERT_NEAR(luma(x, y), 0.299 * r + 0.587 * g + 0.114 * b, 2.0) << x << ' ' << y;
    }
  }
}

TEST(JpegDecoder, LumaDoesNotDependOnHowColourIsStored) {
  const ColorImage8 image = colorful(odd);
  const GrayImage8 full = luma8(make_jpeg(image));
  EXPECT_TRUE(equal(full, luma8(make_jpeg(image, {.chroma_step_x = 2}))));
  EXPECT_TRUE(equal(full, luma8(make_jpeg(image, {.chroma_step_x = 2, .chroma_step_y = 2}))));
  EXPECT_TRUE(equal(full, luma8(make_jpeg(image, {.progressive = true}))));
}

TEST(JpegDecoder, GrayFileGivesItsValuesAndRepeatsThemAsColour) {
  const GrayImage8 image(odd, 77);
  const std::vector<std::byte> file = make_gray_jpeg(image);
  EXPECT_TRUE(equal(luma8(file), image));
  const Expected<ColorImage8> color = decode_color(file);
  ASSERT_TRUE(color) << color.error().message;
  EXPECT_EQ((*color)(36, 22), (Rgb8{77, 77, 77}));
}

TEST(JpegDecoder, ColourComesBack) {
  const ColorImage8 image = colorful(odd);
  const Expected<ColorImage8> color = decode_color(make_jpeg(image, {.quality = 100}));
  ASSERT_TRUE(color) << color.error().message;
  ASSERT_EQ(color->size(), odd);
  for (int y = 0; y < odd.height; ++y)
    for (int x = 0; x < odd.width; ++x)
      for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR((*color)(x, y)[k], image(x, y)[k], 4);
}

TEST(JpegDecoder, SizeIsReadFromTheStartOfTheFile) {
  std::vector<std::byte> file = make_jpeg(colorful({640, 480}));
  file.resize(700);
  const Expected<Size> size = read_size(file);
  ASSERT_TRUE(size) << size.error().message;
  EXPECT_EQ(*size, (Size{640, 480}));
}

TEST(JpegDecoder, BytesAfterTheImageAreAllowed) {
  std::vector<std::byte> file = make_jpeg(colorful(odd));
  file.resize(file.size() + 1000, std::byte{0x5a});
  EXPECT_TRUE(decode_luma(file));
}

TEST(JpegDecoder, MemoryIsUsedAgainWhereItFits) {
  const std::vector<std::byte> file = make_jpeg(colorful(odd));
  Luma luma = GrayImage8(odd);
  const std::uint8_t* memory = std::get<GrayImage8>(luma).data();
  ASSERT_TRUE(decode_luma_into(file, luma));
  EXPECT_EQ(std::get<GrayImage8>(luma).data(), memory);
  EXPECT_TRUE(equal(std::get<GrayImage8>(luma), luma8(file)));

  luma = GrayImage16(odd);
  ASSERT_TRUE(decode_luma_into(file, luma));
  EXPECT_TRUE(equal(std::get<GrayImage8>(luma), luma8(file)));
}

TEST(JpegDecoder, EveryTruncationIsDamage) {
  for (const bool progressive : {false, true}) {
    const std::vector<std::byte> file = make_jpeg(colorful({64, 48}), {.progressive = progressive});
    for (std::size_t length = 0; length < file.size(); ++length) {
      const std::span<const std::byte> part(file.data(), length);
      ASSERT_FALSE(decode_luma(part)) << length << " of " << file.size();
      ASSERT_FALSE(decode_color(part)) << length << " of " << file.size();
    }
  }
}

TEST(JpegDecoder, MessageSaysWhatIsDamaged) {
  std::vector<std::byte> file = make_jpeg(colorful({64, 48}));
  file.resize(file.size() - 2);
  EXPECT_EQ(decode_luma(file).error().message, "damaged JPEG: Premature end of JPEG file");
}

struct Refused {
  std::string name;
  std::vector<std::byte> file;
  ImageLimits limits;
  std::string message;
};

TEST(JpegDecoder, RefusesByHeaderWhatIsOverTheLimits) {
  const std::vector<std::byte> file = make_jpeg(colorful({64, 48}));
  const Refused cases[] = {
      {"a side", jpeg_claiming(file, {16385, 8}), {}, "16385 x 8 pixels: over the limit of 16384 a side"},
      {"bomb",
       jpeg_claiming(file, {16000, 16000}),
       {},
       "16000 x 16000 pixels: over the limit of 64000000 pixels"},
      {"largest side libjpeg reads",
       jpeg_claiming(file, {65500, 65500}),
       {},
       "over the limit of 16384 a side"},
      {"file", file, {.max_file_bytes = 100}, "is over the limit of 100"},
  };
  for (const Refused& refused : cases) {
    const auto size = read_size(refused.file, refused.limits);
    const auto luma = decode_luma(refused.file, refused.limits);
    const auto color = decode_color(refused.file, refused.limits);
    ASSERT_FALSE(size) << refused.name;
    ASSERT_FALSE(luma) << refused.name;
    ASSERT_FALSE(color) << refused.name;
    EXPECT_TRUE(contains(size.error().message, refused.message));
    EXPECT_TRUE(contains(luma.error().message, refused.message));
    EXPECT_TRUE(contains(color.error().message, refused.message));
  }
}

TEST(JpegDecoder, RefusesAFileOfTooManyScans) {
  const std::vector<std::byte> file = make_jpeg(colorful({64, 48}), {.progressive = true});
  ASSERT_TRUE(decode_luma(file));
  const auto luma = decode_luma(file, {.max_jpeg_scans = 2});
  ASSERT_FALSE(luma);
  EXPECT_EQ(luma.error().message, "damaged JPEG: more than 2 scans");
}

TEST(JpegDecoder, RefusesWhatIsNoPhotograph) {
  const auto bytes = [](std::string_view text) {
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    return std::vector<std::byte>(first, first + text.size());
  };
  EXPECT_EQ(decode_luma({}).error().message, "the file is empty");
  EXPECT_EQ(decode_luma(bytes("GIF89a")).error().message, "not a JPEG or PNG file");
  EXPECT_EQ(read_size(bytes("<html>")).error().message, "not a JPEG or PNG file");
  EXPECT_TRUE(contains(decode_luma(bytes("\xff\xd8\xff\xff rubbish")).error().message, "damaged JPEG: "));
  EXPECT_FALSE(decode_luma(make_cmyk_jpeg(odd)));
  EXPECT_FALSE(decode_color(make_cmyk_jpeg(odd)));
  const auto zero = decode_luma(jpeg_claiming(make_jpeg(colorful(odd)), {37, 0}));
  ASSERT_FALSE(zero);
  EXPECT_TRUE(contains(zero.error().message, "Empty JPEG image"));
}

}  // namespace
}  // namespace bodyscan
