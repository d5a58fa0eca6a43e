#pragma once

#include "hal/unique_fd.hpp"
#include "hal/virtual_projector/wire.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>

namespace bodyscan::simulator {

// The other side of the wire, as a program would be it.
class ProjectorClient {
 public:
  explicit ProjectorClient(const std::filesystem::path& path)
      : fd_(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    connected_ = connect(fd_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
    const timeval patience{.tv_sec = 3, .tv_usec = 0};
    setsockopt(fd_.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }

  [[nodiscard]] bool connected() const { return connected_; }
  virtual_projector::Hello greet() {
    virtual_projector::Hello hello{.magic = 0};
    iovec part{&hello, sizeof hello};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    EXPECT_EQ(recvmsg(fd_.get(), &message, 0), static_cast<ssize_t>(sizeof hello));
    int shared = -1;
    if (const cmsghdr* rights = CMSG_FIRSTHDR(&message); rights != nullptr)
      std::memcpy(&shared, CMSG_DATA(rights), sizeof shared);
    memory_fd_ = UniqueFd(shared);
    area_ = std::size_t{hello.width} * hello.height;
    return hello;
  }
  void draw(std::uint32_t buffer, std::uint8_t code) {
    void* memory = mmap(nullptr, 2 * area_, PROT_READ | PROT_WRITE, MAP_SHARED, memory_fd_.get(), 0);
    ASSERT_NE(memory, MAP_FAILED);
    std::memset(static_cast<std::uint8_t*>(memory) + buffer * area_, code, area_);
    munmap(memory, 2 * area_);
  }
  template <class Message>
  void send(const Message& message) {
    ASSERT_EQ(::send(fd_.get(), &message, sizeof message, MSG_NOSIGNAL),
              static_cast<ssize_t>(sizeof message));
  }
  virtual_projector::Flipped flip(std::uint32_t buffer, std::uint32_t sequence) {
    send(virtual_projector::Flip{buffer, sequence});
    return answer();
  }
  virtual_projector::Flipped answer() {
    virtual_projector::Flipped flipped;
    EXPECT_EQ(recv(fd_.get(), &flipped, sizeof flipped, 0), static_cast<ssize_t>(sizeof flipped));
    return flipped;
  }
  [[nodiscard]] bool hung_up() {
    char byte = 0;
    return recv(fd_.get(), &byte, 1, 0) == 0;
  }
  [[nodiscard]] int memory_fd() const { return memory_fd_.get(); }

 private:
  UniqueFd fd_;
  UniqueFd memory_fd_;
  std::size_t area_ = 0;
  bool connected_ = false;
};

}  // namespace bodyscan::simulator
