#include "tools/simulator/serve/ptp/dataset.hpp"

#include "tools/simulator/serve/ptp/codes.hpp"

#include <gtest/gtest.h>

namespace bodyscan::simulator::ptp {
namespace {

TEST(PtpDataset, NumbersAreLittleEndian) {
  const Bytes bytes = DatasetWriter()
                          .put(std::uint8_t{0x01})
                          .put(std::uint16_t{0x0203})
                          .put(std::uint32_t{0x04050607})
                          .put(std::int16_t{-2})
                          .put(Operation::get_object)
                          .take();
  EXPECT_EQ(bytes, (Bytes{0x01, 0x03, 0x02, 0x07, 0x06, 0x05, 0x04, 0xFE, 0xFF, 0x09, 0x10}));
}

TEST(PtpDataset, ReadsWhatItWrote) {
  const Bytes bytes = DatasetWriter()
                          .put(std::uint64_t{0x1122334455667788})
                          .put(std::int8_t{-7})
                          .text("100D5000")
                          .text("")
                          .array(std::vector<std::uint16_t>{1, 2, 3})
                          .take();
  DatasetReader reader(bytes);
  EXPECT_EQ(reader.get<std::uint64_t>(), 0x1122334455667788U);
  EXPECT_EQ(reader.get<std::int8_t>(), -7);
  EXPECT_EQ(reader.text(), "100D5000");
  EXPECT_EQ(reader.text(), "");
  EXPECT_EQ(reader.get<std::uint32_t>(), 3U);
  EXPECT_EQ(reader.rest().size(), 6U);
}

TEST(PtpDataset, AStringCountsItsFinalZero) {
  EXPECT_EQ(DatasetWriter().text("M").take(), (Bytes{2, 'M', 0, 0, 0}));
  EXPECT_EQ(DatasetWriter().text("").take(), (Bytes{0}));
  EXPECT_EQ(DatasetWriter().text(std::string(400, 'x')).bytes().front(), 255);
}

TEST(PtpDataset, EveryTruncationAnswersNothing) {
  const Bytes bytes = DatasetWriter().put(std::uint32_t{5}).text("Nikon").put(std::uint16_t{9}).take();
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    DatasetReader reader({bytes.data(), length});
    reader.get<std::uint32_t>();
    reader.text();
    EXPECT_EQ(reader.get<std::uint16_t>(), std::nullopt) << length;
    EXPECT_TRUE(reader.rest().empty()) << length;
  }
}

TEST(PtpDataset, CharactersBeyondAsciiAreQuestionMarks) {
  const Bytes bytes{3, 0xE9, 0x00, 'a', 0, 0, 0};
  DatasetReader reader(bytes);
  EXPECT_EQ(reader.text(), "?a");
}

}  // namespace
}  // namespace bodyscan::simulator::ptp
