#include "hal/gphoto2/worker_channel.hpp"

#include "hal/gphoto2/picture_memory.hpp"
#include "hal/gphoto2/worker_message.hpp"
#include "process_counts.hpp"

#include <array>
#include <cstring>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>

namespace bodyscan::gphoto2 {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

struct Pair {
  Pair() {
    std::array<int, 2> ends{};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()), 0);
    a = UniqueFd(ends[0]);
    b = UniqueFd(ends[1]);
  }
  UniqueFd a;
  UniqueFd b;
};

std::vector<std::byte> some_bytes(std::size_t count) {
  return std::vector<std::byte>(count, std::byte{42});
}

void send_descriptors(int socket, std::span<const std::byte> bytes, std::size_t count) {
  iovec piece{const_cast<std::byte*>(bytes.data()), bytes.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(8 * sizeof(int))> control{};
  msghdr header{};
  header.msg_iov = &piece;
  header.msg_iovlen = 1;
  header.msg_control = control.data();
  header.msg_controllen = CMSG_SPACE(count * sizeof(int));
  cmsghdr* part = CMSG_FIRSTHDR(&header);
  part->cmsg_level = SOL_SOCKET;
  part->cmsg_type = SCM_RIGHTS;
  part->cmsg_len = CMSG_LEN(count * sizeof(int));
  for (std::size_t i = 0; i < count; ++i)
    std::memcpy(CMSG_DATA(part) + i * sizeof(int), &socket, sizeof socket);
  ASSERT_EQ(::sendmsg(socket, &header, 0), static_cast<ssize_t>(bytes.size()));
}

TEST(WorkerChannel, ADatagramArrivesWholeWithItsDescriptor) {
  const Pair pair;
  const auto bytes = some_bytes(max_message_bytes);
  const UniqueFd memory = *seal_picture(some_bytes(5));
  ASSERT_TRUE(send(pair.a.get(), bytes, memory.get(), steady_clock::now()));
  const auto datagram = receive(pair.b.get(), steady_clock::now());
  ASSERT_TRUE(datagram);
  EXPECT_EQ(datagram->bytes, bytes);
  ASSERT_TRUE(datagram->attachment);
  EXPECT_NE(::fcntl(datagram->attachment.get(), F_GETFD) & FD_CLOEXEC, 0);
  EXPECT_EQ(read_sealed_picture(datagram->attachment.get(), 5), some_bytes(5));
}

TEST(WorkerChannel, NothingIsLateAtTheDeadline) {
  const Pair pair;
  const auto start = steady_clock::now();
  EXPECT_EQ(receive(pair.a.get(), start + milliseconds(60)).error(), ChannelTrouble::late);
  EXPECT_GE(steady_clock::now() - start, milliseconds(60));
  EXPECT_LE(steady_clock::now() - start, milliseconds(1'000));
}

TEST(WorkerChannel, AReaderThatSleepsMakesTheWriterLate) {
  const Pair pair;
  const auto bytes = some_bytes(max_message_bytes);
  tl::expected<void, ChannelTrouble> sent;
  for (int i = 0; i < 1'000 && sent; ++i) sent = send(pair.a.get(), bytes, -1, steady_clock::now());
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error(), ChannelTrouble::late);
}

TEST(WorkerChannel, TheOtherSideGoneIsClosed) {
  Pair pair;
  pair.b.reset();
  EXPECT_EQ(receive(pair.a.get(), no_deadline).error(), ChannelTrouble::closed);
  EXPECT_EQ(send(pair.a.get(), some_bytes(1), -1, no_deadline).error(), ChannelTrouble::closed);
}

TEST(WorkerChannel, TooLargeIsMalformed) {
  const Pair pair;
  ASSERT_TRUE(send(pair.a.get(), some_bytes(max_message_bytes + 1), -1, steady_clock::now()));
  EXPECT_EQ(receive(pair.b.get(), steady_clock::now()).error(), ChannelTrouble::malformed);
}

TEST(WorkerChannel, DescriptorsTooManyAreMalformedAndNoneStaysOpen) {
  const Pair pair;
  const std::size_t before = open_descriptors();
  for (const std::size_t count : {2U, 3U, 8U}) {
    send_descriptors(pair.a.get(), some_bytes(4), count);
    EXPECT_EQ(receive(pair.b.get(), steady_clock::now()).error(), ChannelTrouble::malformed) << count;
    EXPECT_EQ(open_descriptors(), before) << count;
  }
}

TEST(WorkerChannel, AnEmptyDatagramIsTheEndAndLeavesNoDescriptor) {
  const Pair pair;
  const std::size_t before = open_descriptors();
  send_descriptors(pair.a.get(), {}, 2);
  EXPECT_EQ(receive(pair.b.get(), steady_clock::now()).error(), ChannelTrouble::closed);
  EXPECT_EQ(open_descriptors(), before);
}

TEST(PictureMemory, SealedBytesCanBeReadAndNotChanged) {
  const auto memory = seal_picture(some_bytes(100'000));
  ASSERT_TRUE(memory);
  EXPECT_EQ(read_sealed_picture(memory->get(), 100'000), some_bytes(100'000));
  EXPECT_LT(::write(memory->get(), "x", 1), 0);
  EXPECT_NE(::ftruncate(memory->get(), 0), 0);
}

TEST(PictureMemory, WhatIsNotSealedOrHasAnotherSizeIsRefused) {
  const auto sealed = seal_picture(some_bytes(100));
  EXPECT_FALSE(read_sealed_picture(sealed->get(), 99));
  EXPECT_FALSE(read_sealed_picture(sealed->get(), 101));
  const UniqueFd open(::memfd_create("open", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  ASSERT_EQ(::ftruncate(open.get(), 100), 0);
  EXPECT_FALSE(read_sealed_picture(open.get(), 100));
  ASSERT_EQ(::fcntl(open.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW), 0);
  EXPECT_FALSE(read_sealed_picture(open.get(), 100));
  const Pair pair;
  EXPECT_FALSE(read_sealed_picture(pair.a.get(), 0));
  const UniqueFd file(::open("/proc/self/exe", O_RDONLY | O_CLOEXEC));
  EXPECT_FALSE(read_sealed_picture(file.get(), 100));
}

}  // namespace
}  // namespace bodyscan::gphoto2
