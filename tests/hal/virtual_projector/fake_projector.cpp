#include "tests/hal/virtual_projector/fake_projector.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>

namespace bodyscan {

using virtual_projector::Flip;
using virtual_projector::Flipped;
using virtual_projector::Hello;

FakeServer::FakeServer(const std::filesystem::path& socket, std::vector<Behaviour> behaviours)
    : listener_(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0)), behaviours_(std::move(behaviours)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = socket.string();
  EXPECT_LT(name.size(), sizeof address.sun_path);
  std::copy_n(name.begin(), std::min(name.size(), sizeof address.sun_path - 1), address.sun_path);
  EXPECT_EQ(bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(listen(listener_.get(), 0), 0);
  thread_ = std::thread([this] { serve(); });
}

FakeServer::~FakeServer() {
  shutdown(listener_.get(), SHUT_RDWR);
  thread_.join();
}

void FakeServer::serve() {
  for (std::size_t i = 0;; ++i) {
    const UniqueFd client(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (!client) return;
    behaviours_[std::min(i, behaviours_.size() - 1)](client.get());
  }
}

FakeProjector::FakeProjector(const Hello& hello, std::optional<std::size_t> bytes)
    : hello_(hello), memory_(memfd_create("fake projector", MFD_CLOEXEC)) {
  const std::size_t two = std::size_t{2} * hello.width * hello.height;
  EXPECT_EQ(ftruncate(memory_.get(), static_cast<off_t>(bytes.value_or(two))), 0);
}

void FakeProjector::greet(int client) const {
  send_with(client, &hello_, sizeof hello_, {memory_.get()});
}

std::optional<Flip> FakeProjector::next(int client) {
  Flip flip;
  if (recv(client, &flip, sizeof flip, 0) != static_cast<ssize_t>(sizeof flip)) return std::nullopt;
  return flip;
}

void FakeProjector::serve(int client, int flips) {
  greet(client);
  for (; flips != 0; --flips) {
    const std::optional<Flip> flip = next(client);
    if (!flip) return;
    Shown shown{flip->buffer, std::vector<std::uint8_t>(std::size_t{hello_.width} * hello_.height), 0};
    const std::size_t bytes = shown.picture.size();
    EXPECT_EQ(pread(memory_.get(), shown.picture.data(), bytes, static_cast<off_t>(flip->buffer * bytes)),
              static_cast<ssize_t>(bytes));
    shown.time_us = 1000 + flip->sequence;
    const Flipped flipped{flip->sequence, 0, shown.time_us};
    {
      const std::lock_guard lock(mutex_);
      shown_.push_back(std::move(shown));
    }
    send(client, &flipped, sizeof flipped, MSG_NOSIGNAL);
  }
}

std::vector<FakeProjector::Shown> FakeProjector::shown() {
  const std::lock_guard lock(mutex_);
  return std::exchange(shown_, {});
}

void send_with(int client, const void* message, std::size_t bytes, const std::vector<int>& descriptors) {
  std::vector<std::byte> copy(bytes);
  std::memcpy(copy.data(), message, bytes);
  iovec part{copy.data(), bytes};
  constexpr std::size_t most = 8;
  ASSERT_LE(descriptors.size(), most);
  alignas(cmsghdr) std::array<char, CMSG_SPACE(most * sizeof(int))> control{};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  if (!descriptors.empty()) {
    header.msg_control = control.data();
    header.msg_controllen = CMSG_SPACE(descriptors.size() * sizeof(int));
    cmsghdr* attached = CMSG_FIRSTHDR(&header);
    attached->cmsg_level = SOL_SOCKET;
    attached->cmsg_type = SCM_RIGHTS;
    attached->cmsg_len = CMSG_LEN(descriptors.size() * sizeof(int));
    std::memcpy(CMSG_DATA(attached), descriptors.data(), descriptors.size() * sizeof(int));
  }
  sendmsg(client, &header, MSG_NOSIGNAL);
}

}  // namespace bodyscan
