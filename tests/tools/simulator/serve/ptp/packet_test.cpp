#include "tools/simulator/serve/ptp/packet.hpp"

#include <gtest/gtest.h>

namespace bodyscan::simulator::ptp {
namespace {

TEST(PtpPacket, LengthAndTypeComeBeforeThePayload) {
  EXPECT_EQ(encode(PacketType::event, Bytes{1, 2, 3}), (Bytes{11, 0, 0, 0, 8, 0, 0, 0, 1, 2, 3}));
}

TEST(PtpPacket, AStreamIsCutIntoPacketsHoweverItArrives) {
  Bytes stream = encode(PacketType::operation_request, Bytes{1, 2, 3, 4});
  const Bytes second = encode(PacketType::probe_request, {});
  stream.insert(stream.end(), second.begin(), second.end());
  for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
    PacketStream packets;
    std::vector<Packet> found;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      packets.append(std::span(stream).subspan(at, std::min(piece, stream.size() - at)));
      while (std::optional<Packet> packet = packets.next().value()) found.push_back(*packet);
    }
    ASSERT_EQ(found.size(), 2U) << piece;
    EXPECT_EQ(found[0].type, PacketType::operation_request);
    EXPECT_EQ(found[0].payload, (Bytes{1, 2, 3, 4}));
    EXPECT_EQ(found[1].type, PacketType::probe_request);
    EXPECT_TRUE(found[1].payload.empty());
  }
}

TEST(PtpPacket, LengthsThatCannotBeAreRefused) {
  for (const std::uint32_t length : {0U, 7U, static_cast<unsigned>(PacketStream::longest) + 1, 0xFFFFFFFFU}) {
    PacketStream packets;
    packets.append(DatasetWriter().put(length).put(PacketType::operation_request).bytes());
    EXPECT_FALSE(packets.next().has_value()) << length;
  }
}

}  // namespace
}  // namespace bodyscan::simulator::ptp
