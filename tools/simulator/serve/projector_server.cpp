#include "tools/simulator/serve/projector_server.hpp"

#include "tools/simulator/option_range.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

namespace bodyscan::simulator {
namespace {

namespace wire = virtual_projector;

constexpr std::int64_t refresh_mhz = 60'000;
constexpr Clock::duration frame_time{std::chrono::nanoseconds(1'000'000'000'000 / refresh_mhz)};
constexpr std::size_t most_flips = 16;  // a client that does not wait for its answers has gone wrong

sockaddr_un address_of(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  return address;
}

template <class Call>
bool with_address(Call call, int fd, const std::filesystem::path& path) {
  const sockaddr_un address = address_of(path);
  return call(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

UniqueFd seqpacket_socket() {
  return UniqueFd(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
}

// What a server that was killed leaves behind: a socket nobody listens on.
void remove_abandoned(const std::filesystem::path& path) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0 || !S_ISSOCK(status.st_mode)) return;
  const UniqueFd probe = seqpacket_socket();
  if (!with_address(connect, probe.get(), path) && errno == ECONNREFUSED) unlink(path.c_str());
}

bool send_hello(int fd, const SharedPictures& pictures) {
  wire::Hello hello;
  hello.width = static_cast<std::uint32_t>(pictures.size().width);
  hello.height = static_cast<std::uint32_t>(pictures.size().height);
  hello.refresh_mhz = refresh_mhz;
  std::strncpy(hello.edid, "SIM 0001 1", sizeof hello.edid - 1);
  iovec part{&hello, sizeof hello};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  cmsghdr* const rights = CMSG_FIRSTHDR(&message);
  rights->cmsg_level = SOL_SOCKET;
  rights->cmsg_type = SCM_RIGHTS;
  rights->cmsg_len = CMSG_LEN(sizeof(int));
  const int shared = pictures.fd();
  std::memcpy(CMSG_DATA(rights), &shared, sizeof shared);
  return sendmsg(fd, &message, MSG_NOSIGNAL | MSG_DONTWAIT) == static_cast<ssize_t>(sizeof hello);
}

GrayImage8 stretched(GrayImage8 picture, Size size) {
  if (picture.size() == size) return picture;
  GrayImage8 result(size);
  for (int y = 0; y < size.height; ++y) {
    const std::uint8_t* row = picture.row(y * picture.height() / size.height);
    for (int x = 0; x < size.width; ++x) result(x, y) = row[x * picture.width() / size.width];
  }
  return result;
}

}  // namespace

Expected<std::unique_ptr<ProjectorServer>> ProjectorServer::open(std::filesystem::path path, Size panel,
                                                                 EventLoop& loop, Show show) {
  if (path.native().empty() || path.native().size() >= sizeof sockaddr_un::sun_path)
    return usage_error("--projector: a socket's path has 1 to " +
                       std::to_string(sizeof sockaddr_un::sun_path - 1) + " characters");
  std::unique_ptr<ProjectorServer> server(new ProjectorServer(std::move(path), panel, loop, std::move(show)));
  remove_abandoned(server->path_);
  if (const Expected<void> listens = server->listen(); !listens) return tl::unexpected(listens.error());
  return server;
}

ProjectorServer::ProjectorServer(std::filesystem::path path, Size panel, EventLoop& loop, Show show)
    : path_(std::move(path)),
      panel_(panel),
      mode_(panel),
      loop_(&loop),
      show_(std::move(show)),
      first_frame_(Clock::now()) {
  loop.add_timer([this] { return next_due(); }, [this](Moment now) { advance(now); });
}

ProjectorServer::~ProjectorServer() {
  if (client_) loop_->unwatch(client_->fd.get());
  stop_listening();
}

Expected<void> ProjectorServer::listen() {
  UniqueFd listener = seqpacket_socket();
  if (!listener || !with_address(bind, listener.get(), path_))
    return device_error("--projector: " + path_.string() + ": " + std::strerror(errno));
  listener_ = std::move(listener);
  constexpr int backlog = 4;
  if (::listen(listener_.get(), backlog) != 0)
    return device_error("--projector: " + path_.string() + ": " + std::strerror(errno));
  loop_->watch(listener_.get(), POLLIN, [this](short) { accept_client(); });
  return {};
}

void ProjectorServer::stop_listening() {
  if (!listener_) return;
  loop_->unwatch(listener_.get());
  listener_.reset();
  unlink(path_.c_str());
}

void ProjectorServer::accept_client() {
  if (client_) return;
  UniqueFd fd(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
  if (!fd) return;
  Expected<SharedPictures> pictures = SharedPictures::make(mode_);
  if (!pictures || !send_hello(fd.get(), *pictures)) return;
  client_.emplace(Client{std::move(fd), std::move(*pictures)});
  loop_->unwatch(listener_.get());  // the next client waits
  loop_->watch(client_->fd.get(), POLLIN, [this](short) { receive(); });
}

void ProjectorServer::drop_client() {
  if (!client_) return;
  loop_->unwatch(client_->fd.get());
  client_.reset();
  flips_.clear();
  show_(make_picture(GrayImage8(panel_, 0)), Clock::now());
  if (listener_) loop_->watch(listener_.get(), POLLIN, [this](short) { accept_client(); });
}

void ProjectorServer::unplug(Moment until) {
  drop_client();
  stop_listening();
  plugged_in_at_ = until;
}

void ProjectorServer::change_mode(Size mode) {
  mode_ = mode;
  drop_client();
}

void ProjectorServer::receive() {
  wire::Flip flip;
  const ssize_t count = recv(client_->fd.get(), &flip, sizeof flip, MSG_DONTWAIT | MSG_TRUNC);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (count != static_cast<ssize_t>(sizeof flip) || flip.buffer > 1 || flips_.size() >= most_flips) {
    drop_client();
    return;
  }
  if (flips_.empty()) next_frame_ = boundary_after(Clock::now());
  flips_.push_back({make_picture(stretched(client_->pictures.picture(flip.buffer), panel_)), flip.sequence});
}

Moment ProjectorServer::boundary_after(Moment moment) const {
  const auto frames = (moment - first_frame_) / frame_time;
  return first_frame_ + (frames + 1) * frame_time;
}

std::optional<Moment> ProjectorServer::next_due() const {
  if (plugged_in_at_) return plugged_in_at_;
  if (!flips_.empty()) return next_frame_;
  return std::nullopt;
}

void ProjectorServer::advance(Moment now) {
  if (plugged_in_at_ && now >= *plugged_in_at_) {
    plugged_in_at_.reset();
    // Where somebody else has taken the path, the projector stays away.
    if (!listen()) listener_.reset();
  }
  while (!flips_.empty() && now >= next_frame_) {
    const PendingFlip flip = std::move(flips_.front());
    flips_.pop_front();
    show_(flip.picture, next_frame_);
    wire::Flipped flipped;
    flipped.sequence = flip.sequence;
    flipped.time_us =
        std::chrono::duration_cast<std::chrono::microseconds>(next_frame_.time_since_epoch()).count();
    next_frame_ += frame_time;
    if (send(client_->fd.get(), &flipped, sizeof flipped, MSG_DONTWAIT | MSG_NOSIGNAL) !=
        static_cast<ssize_t>(sizeof flipped))
      drop_client();
  }
}

}  // namespace bodyscan::simulator
