#include "hal/drm/edid.hpp"

#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put_checksum(Bytes& edid) {
  unsigned sum = 0;
  for (std::size_t i = 0; i < 127; ++i) sum += edid[i];
  edid[127] = static_cast<std::uint8_t>(256 - sum % 256);
}

void put_descriptor(Bytes& edid, std::size_t start, std::uint8_t tag, std::string_view text) {
  for (std::size_t i = 0; i < 18; ++i) edid[start + i] = i < 5 ? 0 : ' ';
  edid[start + 3] = tag;
  for (std::size_t i = 0; i < text.size(); ++i) edid[start + 5 + i] = static_cast<std::uint8_t>(text[i]);
  put_checksum(edid);
}

// NEC, product 4a21, serial number 1234567; timings where descriptors with texts could be.
Bytes projector() {
  Bytes edid(128, 0);
  for (std::size_t i = 1; i < 7; ++i) edid[i] = 0xff;
  edid[8] = 0x38;  // N 14, E 5, C 3
  edid[9] = 0xa3;
  edid[10] = 0x21;
  edid[11] = 0x4a;
  edid[12] = 0x87;
  edid[13] = 0xd6;
  edid[14] = 0x12;
  for (const std::size_t start : {54U, 72U, 90U, 108U}) edid[start] = 0x64;
  put_checksum(edid);
  return edid;
}

Expected<Edid> parse(const Bytes& bytes) {
  return parse_edid(std::as_bytes(std::span(bytes)));
}

std::string error_of(const Bytes& bytes) {
  const Expected<Edid> edid = parse(bytes);
  if (edid) return "accepted";
  EXPECT_EQ(edid.error().kind, ErrorKind::device);
  return edid.error().message;
}

TEST(Edid, TellsMakerProductAndSerialNumber) {
  const Expected<Edid> edid = parse(projector());
  ASSERT_TRUE(edid) << edid.error().message;
  EXPECT_EQ(edid->maker, "NEC");
  EXPECT_EQ(edid->product, 0x4a21);
  EXPECT_EQ(edid->serial, 1234567U);
  EXPECT_EQ(edid->serial_text, "");
  EXPECT_EQ(edid->name, "");
  EXPECT_EQ(identity(*edid), "NEC 4a21 1234567");
}

TEST(Edid, ReadsTexts) {
  Bytes bytes = projector();
  put_descriptor(bytes, 72, 0xfc, "LT220\n");
  put_descriptor(bytes, 108, 0xff, "4B00017EX1234");  // fills the descriptor, no line feed
  const Expected<Edid> edid = parse(bytes);
  ASSERT_TRUE(edid) << edid.error().message;
  EXPECT_EQ(edid->name, "LT220");
  EXPECT_EQ(edid->serial_text, "4B00017EX1234");
  EXPECT_EQ(identity(*edid), "NEC 4a21 4B00017EX1234");
}

TEST(Edid, ATextIsPrintableWhateverTheDisplaySays) {
  Bytes bytes = projector();
  put_descriptor(bytes, 72, 0xfc, "\x1b[2J\xff\x7f x  \n");
  put_descriptor(bytes, 90, 0xff, "\nrest");
  const Expected<Edid> edid = parse(bytes);
  ASSERT_TRUE(edid) << edid.error().message;
  EXPECT_EQ(edid->name, "?[2J?? x");
  EXPECT_EQ(edid->serial_text, "");
}

TEST(Edid, LeavesOutASerialNumberThatIsNotThere) {
  Bytes bytes = projector();
  bytes[12] = bytes[13] = bytes[14] = bytes[15] = 0;
  put_checksum(bytes);
  EXPECT_EQ(identity(*parse(bytes)), "NEC 4a21");
}

TEST(Edid, ATimingIsNoText) {
  Bytes bytes = projector();
  put_descriptor(bytes, 54, 0xfc, "a timing");
  bytes[54] = 1;
  put_checksum(bytes);
  EXPECT_EQ(parse(bytes)->name, "");
}

TEST(Edid, ALetterThatIsNoneIsAQuestionMark) {
  Bytes bytes = projector();
  bytes[8] = 0x7f;
  bytes[9] = 0xe0;
  put_checksum(bytes);
  EXPECT_EQ(parse(bytes)->maker, "???");
}

TEST(Edid, IgnoresExtensions) {
  Bytes bytes = projector();
  bytes.resize(256, 0xaa);
  EXPECT_TRUE(parse(bytes));
}

TEST(Edid, NamesDamage) {
  EXPECT_EQ(error_of({}), "EDID: 0 bytes, not 128 or more");
  Bytes header = projector();
  header[7] = 1;
  EXPECT_EQ(error_of(header), "EDID: does not begin with an EDID's header");
  Bytes flipped = projector();
  flipped[100] ^= 1;
  EXPECT_EQ(error_of(flipped), "EDID: wrong checksum");
  const Bytes good = projector();
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_EQ(error_of(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size))),
              "EDID: " + std::to_string(size) + " bytes, not 128 or more");
}

TEST(Edid, AnyBytesBehindAGoodHeaderGivePrintableTexts) {
  std::mt19937 random(1);
  for (int round = 0; round < 20'000; ++round) {
    Bytes bytes = projector();
    for (std::size_t i = 8; i < 127; ++i) bytes[i] = static_cast<std::uint8_t>(random());
    for (const std::size_t start : {54U, 72U, 90U, 108U}) {
      bytes[start] = bytes[start + 1] = 0;
      bytes[start + 3] = static_cast<std::uint8_t>(0xfc + random() % 4);
    }
    put_checksum(bytes);
    const Expected<Edid> edid = parse(bytes);
    ASSERT_TRUE(edid);
    for (const std::string& text : {edid->name, identity(*edid)})
      for (const char character : text) ASSERT_TRUE(character >= ' ' && character <= '~');
  }
}

}  // namespace
}  // namespace bodyscan
