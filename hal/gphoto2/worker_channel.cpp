#include "hal/gphoto2/worker_channel.hpp"

#include "hal/gphoto2/worker_message.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <poll.h>
#include <sys/socket.h>

namespace bodyscan::gphoto2 {
namespace {

bool would_block(int code) {
  return code == EAGAIN || code == EWOULDBLOCK;
}

// Takes every descriptor that came, so that none is left open.
std::vector<UniqueFd> take_descriptors(msghdr& header) {
  std::vector<UniqueFd> descriptors;
  for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t count = (part->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < count; ++i) {
      int descriptor = -1;
      std::memcpy(&descriptor, CMSG_DATA(part) + i * sizeof(int), sizeof descriptor);
      descriptors.emplace_back(descriptor);
    }
  }
  return descriptors;
}

}  // namespace

bool wait_for(int descriptor, short events, Deadline deadline) {
  using std::chrono::milliseconds;
  for (;;) {
    int timeout_ms = -1;
    if (deadline != no_deadline) {
      const auto left = std::chrono::ceil<milliseconds>(deadline - std::chrono::steady_clock::now());
      timeout_ms = static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 1'000'000));
    }
    pollfd entry{descriptor, events, 0};
    const int ready = ::poll(&entry, 1, timeout_ms);
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return true;  // the call that follows tells what is wrong
    if (std::chrono::steady_clock::now() >= deadline) return false;
  }
}

tl::expected<void, ChannelTrouble> send(int socket, std::span<const std::byte> bytes, int attachment,
                                        Deadline deadline) {
  iovec piece{const_cast<std::byte*>(bytes.data()), bytes.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  msghdr header{};
  header.msg_iov = &piece;
  header.msg_iovlen = 1;
  if (attachment >= 0) {
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    cmsghdr* part = CMSG_FIRSTHDR(&header);
    part->cmsg_level = SOL_SOCKET;
    part->cmsg_type = SCM_RIGHTS;
    part->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(part), &attachment, sizeof attachment);
  }
  for (;;) {
    if (::sendmsg(socket, &header, MSG_NOSIGNAL | MSG_DONTWAIT) >= 0) return {};
    if (errno == EINTR) continue;
    if (!would_block(errno)) return tl::unexpected(ChannelTrouble::closed);
    if (!wait_for(socket, POLLOUT, deadline)) return tl::unexpected(ChannelTrouble::late);
  }
}

tl::expected<Datagram, ChannelTrouble> receive(int socket, Deadline deadline) {
  Datagram datagram;
  datagram.bytes.resize(max_message_bytes);
  for (;;) {
    iovec piece{datagram.bytes.data(), datagram.bytes.size()};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
    msghdr header{};
    header.msg_iov = &piece;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    const ssize_t count = ::recvmsg(socket, &header, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
    if (count >= 0) {
      std::vector<UniqueFd> descriptors = take_descriptors(header);
      if (count == 0) return tl::unexpected(ChannelTrouble::closed);
      if ((header.msg_flags & (MSG_TRUNC | MSG_CTRUNC)) != 0 || descriptors.size() > 1)
        return tl::unexpected(ChannelTrouble::malformed);
      datagram.bytes.resize(static_cast<std::size_t>(count));
      if (!descriptors.empty()) datagram.attachment = std::move(descriptors.front());
      return datagram;
    }
    if (count < 0 && errno == EINTR) continue;
    if (!would_block(errno)) return tl::unexpected(ChannelTrouble::closed);
    if (!wait_for(socket, POLLIN, deadline)) return tl::unexpected(ChannelTrouble::late);
  }
}

}  // namespace bodyscan::gphoto2
