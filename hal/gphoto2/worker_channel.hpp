#pragma once

#include "hal/unique_fd.hpp"

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <tl/expected.hpp>

namespace bodyscan::gphoto2 {

using Deadline = std::chrono::steady_clock::time_point;
inline constexpr Deadline no_deadline = Deadline::max();

enum class ChannelTrouble {
  closed,     // the other side is gone
  late,       // nothing came, or nothing could be sent, before the deadline
  malformed,  // larger than max_message_bytes, or with more than one descriptor
};

struct Datagram {
  std::vector<std::byte> bytes;
  UniqueFd attachment;
};

// A datagram over one end of a SOCK_SEQPACKET pair, with the descriptor `attachment` if that is not -1.
// Waits until there is room, up to the deadline; signals do not shorten the wait.
tl::expected<void, ChannelTrouble> send(int socket, std::span<const std::byte> bytes, int attachment,
                                        Deadline deadline);
tl::expected<Datagram, ChannelTrouble> receive(int socket, Deadline deadline);

// Waits for poll(2)'s `events`; false once the deadline has passed.
bool wait_for(int descriptor, short events, Deadline deadline);

}  // namespace bodyscan::gphoto2
