// A camera worker without a camera. Each argument says how one request is met: "fetch=unsealed"; every other
// request is answered well. Behaviours: see `misbehave`.
#include "hal/gphoto2/picture_memory.hpp"
#include "hal/gphoto2/worker_channel.hpp"
#include "hal/gphoto2/worker_message.hpp"
#include "hal/gphoto2/worker_process.hpp"

#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>

#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

namespace bodyscan::gphoto2 {
namespace {

using std::chrono::milliseconds;

constexpr std::array request_names{"list", "open", "configure", "expose", "fetch", "preview"};
constexpr std::string_view picture = "\xff\xd8 a picture \xff\xd9";

std::span<const std::byte> picture_bytes() {
  return std::as_bytes(std::span(picture));
}

void reply(std::uint32_t number, const Reply& message, int attachment = -1) {
  if (!send(worker_socket, encode(number, message), attachment, no_deadline)) std::exit(0);
}

UniqueFd unsealed_memory() {
  UniqueFd memory(::memfd_create("open", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (::write(memory.get(), picture.data(), picture.size()) < 0) std::abort();
  return memory;
}

void send_two_descriptors(std::uint32_t number) {
  const UniqueFd memory = *seal_picture(picture_bytes());
  auto bytes = encode(number, Reply(PictureReady{picture.size(), 1}));
  const std::array<int, 2> descriptors{memory.get(), memory.get()};
  iovec piece{bytes.data(), bytes.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof descriptors)> control{};
  msghdr header{};
  header.msg_iov = &piece;
  header.msg_iovlen = 1;
  header.msg_control = control.data();
  header.msg_controllen = control.size();
  cmsghdr* part = CMSG_FIRSTHDR(&header);
  part->cmsg_level = SOL_SOCKET;
  part->cmsg_type = SCM_RIGHTS;
  part->cmsg_len = CMSG_LEN(sizeof descriptors);
  std::memcpy(CMSG_DATA(part), descriptors.data(), sizeof descriptors);
  ::sendmsg(worker_socket, &header, 0);
}

// What a worker inherits, told as an identity.
Opened surroundings() {
  Opened opened;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd"))
    if (const int descriptor = std::stoi(entry.path().filename());
        descriptor > worker_socket &&
        !std::filesystem::read_symlink(entry.path()).string().starts_with("/proc"))
      opened.identity.problems.push_back("descriptor " + std::to_string(descriptor));
  sigset_t blocked;
  sigprocmask(SIG_SETMASK, nullptr, &blocked);
  for (const int number : {SIGINT, SIGTERM, SIGPIPE, SIGHUP}) {
    struct sigaction action = {};
    sigaction(number, nullptr, &action);
    if (action.sa_handler != SIG_DFL || sigismember(&blocked, number) == 1)
      opened.identity.problems.push_back("signal " + std::to_string(number));
  }
  if (::getpgrp() != ::getpid()) opened.identity.problems.emplace_back("process group");
  opened.identity.model = std::getenv("HOME");
  opened.identity.serial = std::getenv("LC_ALL");
  return opened;
}

// True where `behaviour` was one that answers the request itself.
bool misbehave(std::string_view behaviour, std::uint32_t number) {
  if (behaviour == "hang") std::this_thread::sleep_for(std::chrono::hours(1));
  if (behaviour == "die") {
    std::signal(SIGSEGV, SIG_DFL);  // sanitizers handle it
    std::raise(SIGSEGV);
  }
  if (behaviour == "leave") std::exit(7);
  if (behaviour == "refuse") reply(number, Failure{false, "the mode dial is not on M: turn it to M"});
  if (behaviour == "lost") reply(number, Failure{true, "reading: I/O problem"});
  if (behaviour == "garbage") (void)send(worker_socket, std::as_bytes(std::span("garbage")), -1, no_deadline);
  if (behaviour == "oversized") {
    const std::vector<std::byte> bytes(max_message_bytes + 1);
    (void)send(worker_socket, bytes, -1, no_deadline);
  }
  if (behaviour == "empty") (void)send(worker_socket, {}, seal_picture(picture_bytes())->get(), no_deadline);
  if (behaviour == "stale-number") reply(number - 1, Exposed{});
  if (behaviour == "wrong-reply") reply(number, CamerasFound{});
  if (behaviour == "attached") reply(number, Exposed{}, seal_picture(picture_bytes())->get());
  if (behaviour == "no-memory") reply(number, PictureReady{picture.size(), 1});
  if (behaviour == "unsealed") reply(number, PictureReady{picture.size(), 1}, unsealed_memory().get());
  if (behaviour == "wrong-size")
    reply(number, PictureReady{1'000'000, 1}, seal_picture(picture_bytes())->get());
  if (behaviour == "too-large")
    reply(number, PictureReady{max_picture_bytes + 1, 1}, seal_picture(picture_bytes())->get());
  if (behaviour == "socket") reply(number, PictureReady{picture.size(), 1}, worker_socket);
  if (behaviour == "two-descriptors") send_two_descriptors(number);
  if (behaviour == "surroundings") reply(number, surroundings());
  if (behaviour == "progress") reply(number, Progress{});
  if (behaviour == "steady" || behaviour == "endless") {
    for (int i = 0; i < 8 || behaviour == "endless"; ++i) {
      reply(number, Progress{});
      std::this_thread::sleep_for(milliseconds(50));
    }
    return false;
  }
  if (behaviour == "slow") {
    std::this_thread::sleep_for(milliseconds(150));
    return false;
  }
  return !behaviour.empty();
}

void answer(const Numbered<Request>& request) {
  const std::uint32_t number = request.number;
  if (std::holds_alternative<ListCameras>(request.message))
    return reply(number, CamerasFound{{{"Nikon DSC D5000 (PTP mode)", "usb:001,004"}}});
  if (const auto* open = std::get_if<OpenCamera>(&request.message))
    return reply(number, Opened{{"D5000", "1234567", {}}, open->port});
  if (const auto* configure = std::get_if<Configure>(&request.message))
    return reply(number, Configured{configure->wanted});
  if (std::holds_alternative<Expose>(request.message)) return reply(number, Exposed{});
  reply(number, PictureReady{picture.size(), 123'456}, seal_picture(picture_bytes())->get());
}

int serve(std::span<char*> behaviours) {
  for (;;) {
    const auto datagram = receive(worker_socket, no_deadline);
    if (!datagram) {
      for (const std::string_view word : behaviours)
        if (word == "close=hang") std::this_thread::sleep_for(std::chrono::hours(1));
      return 0;
    }
    const auto request = decode_request(datagram->bytes);
    if (!request) return 1;
    const std::string key = request_names[request->message.index()] + std::string("=");
    std::string_view behaviour;
    for (const std::string_view word : behaviours)
      if (word.starts_with(key)) behaviour = word.substr(key.size());
    if (!misbehave(behaviour, request->number)) answer(*request);
  }
}

}  // namespace
}  // namespace bodyscan::gphoto2

int main(int argc, char** argv) {
  return bodyscan::gphoto2::serve(std::span(argv + 1, static_cast<std::size_t>(argc - 1)));
}
