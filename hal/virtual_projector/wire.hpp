#pragma once

#include <cstdint>

namespace bodyscan::virtual_projector {

// A projector that is a program: it listens on a unix socket (SOCK_SEQPACKET) and takes one client at a time.
// It greets a client with a Hello, to which the descriptor of a memory file is attached (SCM_RIGHTS): two
// pictures of width * height bytes, one after the other, 0 black to 255 white, sRGB. The client draws into
// the one that is not shown, sends a Flip, and gets a Flipped once the new picture is on. Closing the socket
// is unplugging; a projector that changes its mode closes it too and greets the next client with the new one.
// Both sides are on one machine: numbers are in its byte order.

inline constexpr std::uint32_t magic = 0x31505642;  // "BVP1"

struct Hello {
  std::uint32_t magic = virtual_projector::magic;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t refresh_mhz = 60'000;  // thousandths of Hz
  char edid[64] = {};                  // zero-terminated
};

struct Flip {
  std::uint32_t buffer = 0;  // 0 or 1
  std::uint32_t sequence = 0;
};

struct Flipped {
  std::uint32_t sequence = 0;  // the Flip's
  std::uint32_t unused = 0;
  std::int64_t time_us = 0;  // CLOCK_MONOTONIC
};

}  // namespace bodyscan::virtual_projector
