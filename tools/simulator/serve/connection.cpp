#include "tools/simulator/serve/connection.hpp"

#include <array>
#include <cerrno>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace bodyscan::simulator {
namespace {

void set_option(int fd, int option) {
  const int on = 1;
  setsockopt(fd, IPPROTO_TCP, option, &on, sizeof on);
}

bool would_wait() {
  return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

}  // namespace

Connection::Connection(UniqueFd fd) : fd_(std::move(fd)) {
  set_option(fd_.get(), TCP_NODELAY);
}

bool Connection::receive() {
  std::array<std::uint8_t, 1 << 16> piece;
  // libgphoto2 sends a request in several small segments with Nagle's algorithm on; a delayed
  // acknowledgement would hold each back for 40 ms. The option lasts for one acknowledgement only.
  set_option(fd_.get(), TCP_QUICKACK);
  const ssize_t count = recv(fd_.get(), piece.data(), piece.size(), MSG_DONTWAIT);
  set_option(fd_.get(), TCP_QUICKACK);
  if (count <= 0) return count < 0 && would_wait();
  packets_.append({piece.data(), static_cast<std::size_t>(count)});
  return true;
}

bool Connection::send(std::span<const std::uint8_t> bytes) {
  unsent_.insert(unsent_.end(), bytes.begin(), bytes.end());
  while (has_unsent()) {
    const ssize_t count =
        ::send(fd_.get(), unsent_.data() + sent_, unsent_.size() - sent_, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (count < 0) return would_wait();
    sent_ += static_cast<std::size_t>(count);
  }
  unsent_.clear();
  sent_ = 0;
  return true;
}

}  // namespace bodyscan::simulator
