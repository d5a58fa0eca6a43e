#pragma once

#include "tools/simulator/serve/ptp/packet.hpp"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace bodyscan::simulator::ptp {

struct Request {
  Operation operation{};
  std::uint32_t transaction = 0;
  std::array<std::uint32_t, 5> parameters{};  // those not sent are 0
  Bytes data;                                 // sent with the request
};

struct Response {
  ResponseCode code = ResponseCode::ok;
  std::vector<std::uint32_t> parameters = {};
  std::shared_ptr<const Bytes> data = nullptr;  // null: the operation has none
};

inline Response with_data(Bytes data) {
  return {ResponseCode::ok, {}, std::make_shared<const Bytes>(std::move(data))};
}

struct Event {
  EventCode code{};
  std::uint32_t parameter = 0;

  friend bool operator==(const Event&, const Event&) = default;
};

// Puts requests together from the packets of a command connection.
class RequestAssembler {
 public:
  // The request that this packet completes, if any; an error where an initiator breaks the protocol.
  Expected<std::optional<Request>> add(const Packet& packet);

 private:
  Expected<std::optional<Request>> begin(const Packet& packet);
  Expected<std::optional<Request>> add_data(const Packet& packet);

  std::optional<Request> waiting_;  // for its data
  bool data_started_ = false;
};

// Data packets, if the response has data, and the response's.
Bytes encode(const Response& response, std::uint32_t transaction);
Bytes encode(const Event& event);

}  // namespace bodyscan::simulator::ptp
