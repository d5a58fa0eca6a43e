#pragma once

#include "hal/unique_fd.hpp"
#include "tools/simulator/serve/ptp/packet.hpp"

#include <optional>
#include <span>

namespace bodyscan::simulator {

// One TCP connection of an initiator, never waiting for it.
class Connection {
 public:
  explicit Connection(UniqueFd fd);

  [[nodiscard]] int fd() const { return fd_.get(); }
  // Takes in what has arrived. False: the other side has gone.
  bool receive();
  Expected<std::optional<ptp::Packet>> next_packet() { return packets_.next(); }

  // Sends as much as the other side takes, and the rest with later calls. False: the other side has gone.
  bool send(std::span<const std::uint8_t> bytes);
  bool flush() { return send({}); }
  [[nodiscard]] bool has_unsent() const { return sent_ < unsent_.size(); }

 private:
  UniqueFd fd_;
  ptp::PacketStream packets_;
  ptp::Bytes unsent_;
  std::size_t sent_ = 0;
};

}  // namespace bodyscan::simulator
