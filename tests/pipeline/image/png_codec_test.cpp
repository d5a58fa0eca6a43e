#include "pipeline/image/codec.hpp"
#include "tests/pipeline/image/image_fixtures.hpp"

#include <cstring>
#include <string>

#include <gtest/gtest.h>
#include <png.h>

namespace bodyscan {
namespace {

testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "\"" << text << "\" does not hold \"" << part << "\"";
}

template <class Pixel>
Image<Pixel> counting(Size size) {
  Image<Pixel> image(size);
  for (std::size_t i = 0; i < size.area(); ++i) image.pixels()[i] = static_cast<Pixel>(i * 257 + 3);
  return image;
}

template <class Pixel>
bool equal(const Image<Pixel>& a, const Image<Pixel>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size().area() * sizeof(Pixel)) == 0;
}

TEST(PngCodec, RoundTripKeepsEveryBit) {
  for (const Size size : {Size{1, 1}, Size{13, 7}, Size{64, 48}}) {
    const auto gray8 = counting<std::uint8_t>(size);
    const auto gray16 = counting<std::uint16_t>(size);
    const ColorImage8 color = colorful(size);
    const auto file8 = encode_png(gray8);
    const auto file16 = encode_png(gray16);
    const auto file_color = encode_png(color);
    ASSERT_TRUE(file8 && file16 && file_color);
    EXPECT_TRUE(equal(std::get<GrayImage8>(decode_luma(*file8).value()), gray8));
    EXPECT_TRUE(equal(std::get<GrayImage16>(decode_luma(*file16).value()), gray16));
    EXPECT_TRUE(equal(decode_color(*file_color).value(), color));
    EXPECT_EQ(read_size(*file16).value(), size);
  }
}

TEST(PngCodec, AnEmptyImageHasNoFile) {
  const auto file = encode_png(GrayImage8());
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().kind, ErrorKind::output);
}

// Two pixels, the second with other values, in every form PNG has.
struct Form {
  std::string name;
  PngOptions options;
  std::vector<std::uint8_t> samples;
  std::vector<int> luma;
  Rgb8 second_color;
};

const Form forms[] = {
    {"1 bit", {PNG_COLOR_TYPE_GRAY, 1}, {0b01000000}, {0, 255}, {255, 255, 255}},
    {"2 bit", {PNG_COLOR_TYPE_GRAY, 2}, {0b01100000}, {85, 170}, {170, 170, 170}},
    {"4 bit", {PNG_COLOR_TYPE_GRAY, 4}, {0x3c}, {51, 204}, {204, 204, 204}},
    {"8 bit", {PNG_COLOR_TYPE_GRAY, 8}, {7, 200}, {7, 200}, {200, 200, 200}},
    {"16 bit", {PNG_COLOR_TYPE_GRAY, 16}, {0x12, 0x34, 0xab, 0xcd}, {0x1234, 0xabcd}, {171, 171, 171}},
    {"grey and alpha", {PNG_COLOR_TYPE_GRAY_ALPHA, 8}, {7, 1, 200, 0}, {7, 200}, {200, 200, 200}},
    {"grey and alpha, 16 bit",
     {PNG_COLOR_TYPE_GRAY_ALPHA, 16},
     {0x12, 0x34, 0, 0, 0xab, 0xcd, 9, 9},
     {0x1234, 0xabcd},
     {171, 171, 171}},
    {"RGB", {PNG_COLOR_TYPE_RGB, 8}, {0, 255, 0, 100, 50, 25}, {150, 62}, {100, 50, 25}},
    {"RGB and alpha",
     {PNG_COLOR_TYPE_RGB_ALPHA, 8},
     {0, 255, 0, 9, 100, 50, 25, 0},
     {150, 62},
     {100, 50, 25}},
    {"RGB, 16 bit",
     {PNG_COLOR_TYPE_RGB, 16},
     {0, 0, 0xff, 0xff, 0, 0, 0x64, 0, 0x32, 0, 0x19, 0},
     {38469, 15898},
     {100, 50, 25}},
    {"palette", {PNG_COLOR_TYPE_PALETTE, 8}, {0, 100}, {150, 156}, {200, 155, 50}},
    {"palette of 4 bit", {PNG_COLOR_TYPE_PALETTE, 4}, {0x0f}, {150, 151}, {30, 240, 7}},
};

std::vector<int> values(const Luma& luma) {
  return std::visit(
      [](const auto& image) { return std::vector<int>(image.pixels().begin(), image.pixels().end()); }, luma);
}

TEST(PngCodec, LumaAndColourOfEveryForm) {
  for (const Form& form : forms) {
    for (const bool interlaced : {false, true}) {
      PngOptions options = form.options;
      options.interlaced = interlaced;
      const std::vector<std::byte> file = make_png({2, 1}, options, form.samples);
      const Expected<Luma> luma = decode_luma(file);
      ASSERT_TRUE(luma) << form.name << ": " << luma.error().message;
      EXPECT_EQ(values(*luma), form.luma) << form.name;
      EXPECT_EQ(std::holds_alternative<GrayImage16>(*luma), options.depth == 16) << form.name;
      const Expected<ColorImage8> color = decode_color(file);
      ASSERT_TRUE(color) << form.name << ": " << color.error().message;
      EXPECT_EQ((*color)(1, 0), form.second_color) << form.name;
    }
  }
}

TEST(PngCodec, InterlacedRowsComeBackInOrder) {
  const ColorImage8 image = colorful({29, 17});
  const std::span<const std::uint8_t> samples(image.data()->data(), image.size().area() * 3);
  const PngOptions plain{.color_type = PNG_COLOR_TYPE_RGB};
  const PngOptions interlaced{.color_type = PNG_COLOR_TYPE_RGB, .interlaced = true};
  const auto file = make_png(image.size(), interlaced, samples);
  EXPECT_TRUE(equal(decode_color(file).value(), image));
  EXPECT_EQ(values(decode_luma(file).value()),
            values(decode_luma(make_png(image.size(), plain, samples)).value()));
}

TEST(PngCodec, AGammaChunkChangesNothing) {
  const std::vector<std::uint8_t> samples{0, 255, 0, 100, 50, 25};
  const auto file = make_png({2, 1}, {.color_type = PNG_COLOR_TYPE_RGB, .gamma = 0.45455}, samples);
  EXPECT_EQ(values(decode_luma(file).value()), (std::vector{150, 62}));
}

TEST(PngCodec, MemoryIsUsedAgainWhereItFits) {
  const auto image = counting<std::uint16_t>({5, 4});
  Luma luma = GrayImage16(Size{5, 4});
  const std::uint16_t* memory = std::get<GrayImage16>(luma).data();
  ASSERT_TRUE(decode_luma_into(encode_png(image).value(), luma));
  EXPECT_EQ(std::get<GrayImage16>(luma).data(), memory);
  EXPECT_TRUE(equal(std::get<GrayImage16>(luma), image));
}

TEST(PngCodec, EveryTruncationIsDamage) {
  for (const bool interlaced : {false, true}) {
    const ColorImage8 image = colorful({16, 12});
    const auto file = make_png(image.size(), {.color_type = PNG_COLOR_TYPE_RGB, .interlaced = interlaced},
                               {image.data()->data(), image.size().area() * 3});
    for (std::size_t length = 0; length < file.size(); ++length) {
      const std::span<const std::byte> part(file.data(), length);
      ASSERT_FALSE(decode_luma(part)) << length << " of " << file.size();
      ASSERT_FALSE(decode_color(part)) << length << " of " << file.size();
    }
    EXPECT_EQ(decode_luma(std::span(file).first(file.size() - 4)).error().message,
              "damaged PNG: the file ends early");
  }
}

TEST(PngCodec, AChangedPixelByteIsDamage) {
  auto file = encode_png(counting<std::uint8_t>({16, 12})).value();
  file[file.size() - 12 - 8] ^= std::byte{1};  // before IEND (12 bytes) and the checksum
  const auto luma = decode_luma(file);
  ASSERT_FALSE(luma);
  EXPECT_TRUE(contains(luma.error().message, "damaged PNG: "));
}

TEST(PngCodec, RefusesByHeaderWhatIsOverTheLimits) {
  const auto file = encode_png(counting<std::uint8_t>({16, 12})).value();
  const auto message = [](const auto& result) { return result ? "accepted" : result.error().message; };
  const auto side = png_claiming(file, 16385, 1);
  const auto bomb = png_claiming(file, 16000, 16000);
  const auto huge = png_claiming(file, 0x7fffffff, 0x7fffffff);
  for (const auto& [refused, reason] :
       {std::pair{&side, "16385 x 1 pixels: over the limit of 16384 a side"},
        std::pair{&bomb, "16000 x 16000 pixels: over the limit of 64000000 pixels"},
        std::pair{&huge, "2147483647 x 2147483647 pixels: over the limit of 16384 a side"}}) {
    EXPECT_EQ(message(read_size(*refused)), reason);
    EXPECT_EQ(message(decode_luma(*refused)), reason);
    EXPECT_EQ(message(decode_color(*refused)), reason);
  }
  EXPECT_FALSE(decode_luma(png_claiming(file, 0, 5)));
  EXPECT_TRUE(contains(message(decode_luma(file, {.max_file_bytes = 20})), "is over the limit of 20"));
  EXPECT_FALSE(decode_luma(png_claiming(file, 16, 13)));  // a row more than there is
}

}  // namespace
}  // namespace bodyscan
