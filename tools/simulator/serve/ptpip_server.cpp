#include "tools/simulator/serve/ptpip_server.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

namespace bodyscan::simulator {
namespace {

using ptp::DatasetWriter;
using ptp::Packet;
using ptp::PacketType;

constexpr std::uint32_t protocol_version = 0x00010000;
constexpr std::size_t most_peers = 16;

// The responder's GUID, its name as UTF-16 with a final zero (no count as in a dataset's string), the
// version.
ptp::Bytes introduction(std::uint32_t connection_number) {
  DatasetWriter writer;
  writer.put(connection_number);
  for (std::uint8_t i = 0; i < 16; ++i) writer.put(i);
  for (const char character : {'D', '5', '0', '0', '0', '\0'})
    writer.put(static_cast<std::uint16_t>(character));
  writer.put(protocol_version);
  return ptp::encode(PacketType::init_command_ack, writer.bytes());
}

}  // namespace

Expected<std::unique_ptr<PtpIpServer>> PtpIpServer::open(int port, EventLoop& loop, Camera& camera) {
  const auto failed = [&] {
    return device_error("--port: 127.0.0.1:" + std::to_string(port) + ": " + std::strerror(errno));
  };
  UniqueFd listener(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int on = 1;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof address;
  auto* const any_address = reinterpret_cast<sockaddr*>(&address);
  if (!listener || setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
      bind(listener.get(), any_address, length) != 0 || listen(listener.get(), SOMAXCONN) != 0 ||
      getsockname(listener.get(), any_address, &length) != 0)
    return failed();
  return std::unique_ptr<PtpIpServer>(
      new PtpIpServer(std::move(listener), ntohs(address.sin_port), loop, camera));
}

PtpIpServer::PtpIpServer(UniqueFd listener, int port, EventLoop& loop, Camera& camera)
    : loop_(&loop), camera_(&camera), listener_(std::move(listener)), port_(port) {
  loop.watch(listener_.get(), POLLIN, [this](short) { accept_peer(); });
  loop.add_timer([this] { return camera_->next_due(); },
                 [this](Moment now) {
                   camera_->advance(now);
                   after_camera();
                 });
}

PtpIpServer::~PtpIpServer() {
  for (const Peer& peer : peers_) loop_->unwatch(peer.connection.fd());
  loop_->unwatch(listener_.get());
}

void PtpIpServer::accept_peer() {
  UniqueFd fd(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
  if (!fd || peers_.size() >= most_peers) return;
  peers_.push_back({Connection(std::move(fd))});
  const Place peer = std::prev(peers_.end());
  loop_->watch(peer->connection.fd(), POLLIN, [this, peer](short events) { serve(peer, events); });
}

void PtpIpServer::serve(Place peer, short events) {
  bool goes_on = true;
  if ((events & POLLOUT) != 0) goes_on = send(peer, {});
  if (goes_on && (events & ~POLLOUT) != 0) goes_on = peer->connection.receive() && serve_packets(peer);
  if (!goes_on) drop(peer);
  after_camera();
}

bool PtpIpServer::serve_packets(Place peer) {
  for (;;) {
    const Expected<std::optional<Packet>> packet = peer->connection.next_packet();
    if (!packet) return false;
    if (!*packet) return true;
    const bool served = peer->role == Role::unknown ? introduce(peer, **packet) : answer(peer, **packet);
    if (!served) return false;
  }
}

bool PtpIpServer::introduce(Place peer, const Packet& packet) {
  if (packet.type == PacketType::init_command_request) return become_command(peer, packet);
  return packet.type == PacketType::init_event_request && become_event(peer, packet);
}

bool PtpIpServer::become_command(Place peer, const Packet& packet) {
  constexpr std::size_t guid_and_version = 16 + 4;
  if (packet.payload.size() < guid_and_version) return false;
  drop_initiator();
  peer->role = Role::command;
  if (!camera_->connect()) return true;
  return send(peer, introduction(++connection_number_));
}

bool PtpIpServer::become_event(Place peer, const Packet& packet) {
  ptp::DatasetReader reader(packet.payload);
  if (reader.get<std::uint32_t>() != connection_number_) return false;
  peer->role = Role::event;
  return send(peer, ptp::encode(PacketType::init_event_ack, {}));
}

bool PtpIpServer::answer(Place peer, const Packet& packet) {
  if (packet.type == PacketType::probe_request)
    return send(peer, ptp::encode(PacketType::probe_response, {}));
  if (packet.type == PacketType::probe_response) return true;
  if (peer->role == Role::event) return packet.type == PacketType::cancel_transaction;
  const Expected<std::optional<ptp::Request>> request = peer->requests.add(packet);
  if (!request) return false;
  if (!*request) return true;
  const std::optional<ptp::Response> response = camera_->execute(**request, Clock::now());
  return !response || send(peer, ptp::encode(*response, (*request)->transaction));
}

bool PtpIpServer::send(Place peer, const ptp::Bytes& bytes) {
  if (!peer->connection.send(bytes)) return false;
  const short events = peer->connection.has_unsent() ? POLLIN | POLLOUT : POLLIN;
  loop_->watch(peer->connection.fd(), events, [this, peer](short ready) { serve(peer, ready); });
  return true;
}

void PtpIpServer::drop(Place peer) {
  loop_->unwatch(peer->connection.fd());
  peers_.erase(peer);
}

void PtpIpServer::drop_initiator() {
  for (Place peer = peers_.begin(); peer != peers_.end();) {
    const Place next = std::next(peer);
    if (peer->role != Role::unknown) drop(peer);
    peer = next;
  }
}

void PtpIpServer::after_camera() {
  if (camera_->take_disconnection()) drop_initiator();
  const auto listener = std::ranges::find(peers_, Role::event, &Peer::role);
  for (const ptp::Event& event : camera_->take_events()) {
    if (listener != peers_.end() && !listener->connection.send(ptp::encode(event))) break;
  }
}

}  // namespace bodyscan::simulator
