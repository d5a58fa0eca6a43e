#include "tools/simulator/serve/ptp/transaction.hpp"

#include <gtest/gtest.h>

namespace bodyscan::simulator::ptp {
namespace {

constexpr std::uint32_t no_data = 1;
constexpr std::uint32_t transaction = 7;

Packet request_packet(std::uint32_t data_phase, std::vector<std::uint32_t> parameters) {
  DatasetWriter writer;
  writer.put(data_phase).put(Operation::set_device_prop_value).put(transaction);
  for (const std::uint32_t parameter : parameters) writer.put(parameter);
  return {PacketType::operation_request, writer.take()};
}

Packet data_packet(PacketType type, const Bytes& data, std::uint32_t number = transaction) {
  return {type, DatasetWriter().put(number).raw(data).take()};
}

TEST(PtpTransaction, ARequestWithoutDataIsWholeAtOnce) {
  RequestAssembler requests;
  const std::optional<Request> request = requests.add(request_packet(no_data, {5, 6})).value();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->operation, Operation::set_device_prop_value);
  EXPECT_EQ(request->transaction, transaction);
  EXPECT_EQ(request->parameters, (std::array<std::uint32_t, 5>{5, 6, 0, 0, 0}));
}

TEST(PtpTransaction, DataAreGatheredUntilTheEnd) {
  RequestAssembler requests;
  EXPECT_FALSE(requests.add(request_packet(data_phase_out, {0x500D})).value());
  EXPECT_FALSE(requests.add(data_packet(PacketType::start_data, Bytes(8))).value());
  EXPECT_FALSE(requests.add(data_packet(PacketType::data, {1, 2})).value());
  const std::optional<Request> request = requests.add(data_packet(PacketType::end_data, {3})).value();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->data, (Bytes{1, 2, 3}));
}

TEST(PtpTransaction, WhatBreaksTheProtocolIsRefused) {
  const auto refused = [](const std::vector<Packet>& packets) {
    RequestAssembler requests;
    bool fails = false;
    for (const Packet& packet : packets) fails = !requests.add(packet).has_value();
    return fails;
  };
  const Packet announced = request_packet(data_phase_out, {0x500D});
  const Packet start = data_packet(PacketType::start_data, Bytes(8));
  EXPECT_TRUE(refused({{PacketType::operation_request, {1, 0, 0}}}));
  EXPECT_TRUE(refused({{PacketType::event, {}}}));
  EXPECT_TRUE(refused({start}));
  EXPECT_TRUE(refused({announced, announced}));
  EXPECT_TRUE(refused({announced, data_packet(PacketType::data, {1})}));
  EXPECT_TRUE(refused({announced, start, start}));
  EXPECT_TRUE(refused({announced, start, data_packet(PacketType::data, {1}, transaction + 1)}));
  EXPECT_TRUE(refused({announced, start, {PacketType::end_data, {7, 0}}}));
  EXPECT_TRUE(refused({announced, start, data_packet(PacketType::data, Bytes(PacketStream::longest)),
                       data_packet(PacketType::data, {1})}));
  EXPECT_FALSE(refused({announced, start, {PacketType::cancel_transaction, {}}, announced}));
}

std::vector<Packet> packets_of(const Bytes& bytes) {
  PacketStream stream;
  stream.append(bytes);
  std::vector<Packet> packets;
  while (std::optional<Packet> packet = stream.next().value()) packets.push_back(*packet);
  return packets;
}

TEST(PtpTransaction, AResponseCarriesItsDataBeforeIt) {
  Bytes data(600'000);
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::uint8_t>(i * 7);
  const std::vector<Packet> packets = packets_of(encode(with_data(data), transaction));
  ASSERT_GE(packets.size(), 3U);
  EXPECT_EQ(packets.front().type, PacketType::start_data);
  DatasetReader start(packets.front().payload);
  EXPECT_EQ(start.get<std::uint32_t>(), transaction);
  EXPECT_EQ(start.get<std::uint64_t>(), data.size());
  Bytes received;
  for (std::size_t i = 1; i + 1 < packets.size(); ++i) {
    EXPECT_EQ(packets[i].type, i + 2 == packets.size() ? PacketType::end_data : PacketType::data);
    received.insert(received.end(), packets[i].payload.begin() + 4, packets[i].payload.end());
  }
  EXPECT_EQ(received, data);
  EXPECT_EQ(packets.back().type, PacketType::operation_response);
}

TEST(PtpTransaction, EmptyDataAreStillSent) {
  const std::vector<Packet> packets = packets_of(encode(with_data({}), transaction));
  ASSERT_EQ(packets.size(), 3U);
  EXPECT_EQ(packets[1].type, PacketType::end_data);
}

TEST(PtpTransaction, AnErrorIsAResponseAlone) {
  const std::vector<Packet> packets =
      packets_of(encode(Response{ResponseCode::device_busy, {3}}, transaction));
  ASSERT_EQ(packets.size(), 1U);
  DatasetReader reader(packets[0].payload);
  EXPECT_EQ(reader.get<ResponseCode>(), ResponseCode::device_busy);
  EXPECT_EQ(reader.get<std::uint32_t>(), transaction);
  EXPECT_EQ(reader.get<std::uint32_t>(), 3U);
}

}  // namespace
}  // namespace bodyscan::simulator::ptp
