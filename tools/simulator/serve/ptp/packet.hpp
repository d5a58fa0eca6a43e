#pragma once

#include "pipeline/base/error.hpp"
#include "tools/simulator/serve/ptp/codes.hpp"
#include "tools/simulator/serve/ptp/dataset.hpp"

#include <optional>
#include <span>

namespace bodyscan::simulator::ptp {

struct Packet {
  PacketType type;
  Bytes payload;
};

// A packet as it goes over the wire: its length, its type, its payload.
Bytes encode(PacketType type, std::span<const std::uint8_t> payload);

// Cuts a stream of bytes into packets.
class PacketStream {
 public:
  // The longest packet taken from an initiator, which sends no pictures.
  static constexpr std::size_t longest = 1 << 20;

  void append(std::span<const std::uint8_t> bytes);
  // The next whole packet; nothing where more bytes are needed; an error where the length makes no sense,
  // after which the stream is lost.
  Expected<std::optional<Packet>> next();

 private:
  Bytes bytes_;
};

}  // namespace bodyscan::simulator::ptp
