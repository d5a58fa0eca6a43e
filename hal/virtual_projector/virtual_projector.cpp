#include "hal/virtual_projector/virtual_projector.hpp"

#include "hal/clock.hpp"
#include "hal/virtual_projector/wire.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>

#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>

namespace bodyscan {
namespace {

using virtual_projector::Flip;
using virtual_projector::Flipped;
using virtual_projector::Hello;
using virtual_projector::magic;

constexpr std::int64_t answer_us = 1'000'000;
constexpr std::uint32_t max_side_px = 16384;

struct Greeting {
  UniqueFd socket;
  UniqueFd memory;
  Hello hello;
};

std::string told(const std::filesystem::path& path, const std::string& what) {
  return "projector at " + path.string() + ": " + what;
}

// Nothing once the time is up or the peer is gone.
bool wait_readable(int fd, std::int64_t until_us) {
  for (;;) {
    const std::int64_t left = until_us - monotonic_us();
    if (left <= 0) return false;
    pollfd waiting{fd, POLLIN, 0};
    const int ready = poll(&waiting, 1, static_cast<int>((left + 999) / 1000));
    if (ready > 0) return (waiting.revents & POLLIN) != 0;
    if (ready == 0 || errno != EINTR) return false;
  }
}

Expected<UniqueFd> connect_to(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = path.string();
  if (name.size() >= sizeof address.sun_path)
    return device_error(told(path, "the socket's name is too long"));
  std::copy(name.begin(), name.end(), address.sun_path);
  UniqueFd socket(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
  // A projector that is busy with others keeps a client waiting before it is connected.
  const timeval patience{answer_us / 1'000'000, answer_us % 1'000'000};
  if (socket) setsockopt(socket.get(), SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  if (!socket || connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return device_error(
        told(path, errno == EAGAIN ? "does not answer" : std::string("not there: ") + std::strerror(errno)));
  return socket;
}

// The message and the descriptor that travels with it.
Expected<Greeting> greet(const std::filesystem::path& path) {
  Expected<UniqueFd> socket = connect_to(path);
  if (!socket) return tl::unexpected(socket.error());
  Greeting greeting{std::move(*socket), {}, {}};
  if (!wait_readable(greeting.socket.get(), monotonic_us() + answer_us))
    return device_error(told(path, "does not answer"));
  iovec part{&greeting.hello, sizeof greeting.hello};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t received = recvmsg(greeting.socket.get(), &message, MSG_CMSG_CLOEXEC);
  bool only_memory = false;
  if (const cmsghdr* header = CMSG_FIRSTHDR(&message);
      header != nullptr && header->cmsg_level == SOL_SOCKET && header->cmsg_type == SCM_RIGHTS) {
    // The buffer's padding has room for another one.
    for (std::size_t at = 0; CMSG_LEN(at + sizeof(int)) <= header->cmsg_len; at += sizeof(int)) {
      int fd = -1;
      std::memcpy(&fd, CMSG_DATA(header) + at, sizeof fd);
      UniqueFd descriptor(fd);
      if (at == 0) greeting.memory = std::move(descriptor);
      only_memory = at == 0;
    }
  }
  const Hello& hello = greeting.hello;
  const bool sound = received == static_cast<ssize_t>(sizeof hello) && hello.magic == magic && only_memory &&
                     hello.width > 0 && hello.height > 0 && hello.width <= max_side_px &&
                     hello.height <= max_side_px;
  if (!sound) return device_error(told(path, "is no virtual projector"));
  return greeting;
}

DisplayMode mode_of(const Hello& hello) {
  return {{static_cast<int>(hello.width), static_cast<int>(hello.height)}, hello.refresh_mhz / 1000.0};
}

std::string edid_of(const Hello& hello) {
  return {hello.edid, strnlen(hello.edid, sizeof hello.edid)};
}

// Empty where the memory is not as large as two pictures.
std::span<std::byte> map(const Greeting& greeting) {
  const std::size_t bytes = 2 * mode_of(greeting.hello).size.area();
  struct stat status {};
  if (fstat(greeting.memory.get(), &status) != 0 || static_cast<std::size_t>(status.st_size) < bytes)
    return {};
  void* memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, greeting.memory.get(), 0);
  if (memory == MAP_FAILED) return {};
  return {static_cast<std::byte*>(memory), bytes};
}

}  // namespace

VirtualProjector::VirtualProjector(std::filesystem::path socket, ProjectorChoice choice)
    : path_(std::move(socket)), choice_(std::move(choice)) {}

VirtualProjector::~VirtualProjector() {
  VirtualProjector::close();
}

Expected<ProjectorOutput> VirtualProjector::identify(const std::filesystem::path& socket) {
  const Expected<Greeting> greeting = greet(socket);
  if (!greeting) return tl::unexpected(greeting.error());
  return ProjectorOutput{socket.string(), edid_of(greeting->hello), {mode_of(greeting->hello)}};
}

Expected<void> VirtualProjector::open() {
  close();
  lost_ = false;
  Expected<Greeting> greeting = greet(path_);
  if (!greeting) return tl::unexpected(greeting.error());
  const DisplayMode mode = mode_of(greeting->hello);
  if (mode != choice_.mode)
    return device_error(told(path_, "its mode is " + describe(mode) + ", the calibration needs " +
                                        describe(choice_.mode) + ": set that mode, or calibrate anew"));
  const std::string edid = edid_of(greeting->hello);
  if (!choice_.edid.empty() && edid != choice_.edid)
    return device_error(told(path_, "it is '" + edid + "', not the '" + choice_.edid + "' of the rig file"));
  pictures_ = map(*greeting);
  if (pictures_.empty()) return device_error(told(path_, "its memory does not hold two pictures"));
  socket_ = std::move(greeting->socket);
  sequence_ = 0;
  return show(GrayImage8(mode.size, 0)).map([](std::int64_t) {});
}

Expected<std::int64_t> VirtualProjector::show(const GrayImage8& picture) {
  if (!socket_)
    return device_error(told(path_, lost_ ? "was lost and must be opened again" : "is closed, not open"));
  if (picture.size() != choice_.mode.size)
    return device_error(told(path_, "a picture of another size than its mode"));
  const Flip flip{++sequence_ % 2, sequence_};
  std::memcpy(pictures_.data() + flip.buffer * picture.size().area(), picture.data(), picture.size().area());
  if (send(socket_.get(), &flip, sizeof flip, MSG_NOSIGNAL) != static_cast<ssize_t>(sizeof flip))
    return lose("was unplugged");
  const std::int64_t until = monotonic_us() + answer_us;
  Flipped flipped;
  do {
    if (!wait_readable(socket_.get(), until)) return lose("does not show the picture");
    if (recv(socket_.get(), &flipped, sizeof flipped, 0) != static_cast<ssize_t>(sizeof flipped))
      return lose("was unplugged");
  } while (flipped.sequence != flip.sequence);
  return flipped.time_us;
}

void VirtualProjector::close() {
  if (socket_) {
    // A failure here is a projector that is gone, and so dark.
    const auto dark = show(GrayImage8(choice_.mode.size, 0));
    static_cast<void>(dark);
  }
  socket_.reset();
  if (!pictures_.empty()) munmap(pictures_.data(), pictures_.size());
  pictures_ = {};
}

tl::unexpected<Error> VirtualProjector::lose(const std::string& reason) {
  socket_.reset();
  lost_ = true;
  return device_error(told(path_, reason + ": check its cable and power"));
}

}  // namespace bodyscan
