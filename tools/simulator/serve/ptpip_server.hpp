#pragma once

#include "pipeline/base/error.hpp"
#include "tools/simulator/serve/camera.hpp"
#include "tools/simulator/serve/connection.hpp"
#include "tools/simulator/serve/event_loop.hpp"

#include <list>

namespace bodyscan::simulator {

// Puts a camera on the network (PTP/IP, CIPA DC-005) at 127.0.0.1: a command and an event connection of one
// initiator at a time. A new initiator takes the place of the last one.
class PtpIpServer {
 public:
  // Port 0: any free one. `loop` and `camera` must outlive the server.
  static Expected<std::unique_ptr<PtpIpServer>> open(int port, EventLoop& loop, Camera& camera);
  PtpIpServer(const PtpIpServer&) = delete;
  PtpIpServer& operator=(const PtpIpServer&) = delete;
  ~PtpIpServer();

  [[nodiscard]] int port() const { return port_; }

 private:
  enum class Role { unknown, command, event };
  struct Peer {
    Connection connection;
    Role role = Role::unknown;
    ptp::RequestAssembler requests = {};
  };
  using Place = std::list<Peer>::iterator;

  PtpIpServer(UniqueFd listener, int port, EventLoop& loop, Camera& camera);
  void accept_peer();
  void serve(Place peer, short events);
  // False: the peer breaks the protocol, or has gone.
  bool serve_packets(Place peer);
  bool introduce(Place peer, const ptp::Packet& packet);
  bool become_command(Place peer, const ptp::Packet& packet);
  bool become_event(Place peer, const ptp::Packet& packet);
  bool answer(Place peer, const ptp::Packet& packet);
  bool send(Place peer, const ptp::Bytes& bytes);
  void drop(Place peer);
  void drop_initiator();
  void after_camera();

  EventLoop* loop_;
  Camera* camera_;
  UniqueFd listener_;
  int port_;
  std::uint32_t connection_number_ = 0;  // of the current initiator
  std::list<Peer> peers_;
};

}  // namespace bodyscan::simulator
