#include "tools/simulator/serve/ptp/packet.hpp"

namespace bodyscan::simulator::ptp {
namespace {

constexpr std::size_t header = 8;

}  // namespace

Bytes encode(PacketType type, std::span<const std::uint8_t> payload) {
  DatasetWriter writer;
  writer.put(static_cast<std::uint32_t>(header + payload.size())).put(type).raw(payload);
  return writer.take();
}

void PacketStream::append(std::span<const std::uint8_t> bytes) {
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

Expected<std::optional<Packet>> PacketStream::next() {
  if (bytes_.size() < header) return std::nullopt;
  DatasetReader reader(bytes_);
  const std::uint32_t length = *reader.get<std::uint32_t>();
  const PacketType type = *reader.get<PacketType>();
  if (length < header || length > longest)
    return device_error("a packet of " + std::to_string(length) + " bytes");
  if (bytes_.size() < length) return std::nullopt;
  const auto end = bytes_.begin() + length;
  Packet packet{type, Bytes(bytes_.begin() + header, end)};
  bytes_.erase(bytes_.begin(), end);
  return packet;
}

}  // namespace bodyscan::simulator::ptp
