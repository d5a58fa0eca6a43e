#include "tools/simulator/serve/ptp/transaction.hpp"

#include <algorithm>
#include <utility>

namespace bodyscan::simulator::ptp {
namespace {

void append(Bytes& bytes, const Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

Bytes data_packets(const Bytes& data, std::uint32_t transaction) {
  constexpr std::size_t block = 1 << 18;
  Bytes bytes = encode(PacketType::start_data,
                       DatasetWriter().put(transaction).put(static_cast<std::uint64_t>(data.size())).take());
  std::size_t sent = 0;
  do {
    const std::size_t count = std::min(block, data.size() - sent);
    const bool last = sent + count == data.size();
    append(bytes, encode(last ? PacketType::end_data : PacketType::data,
                         DatasetWriter().put(transaction).raw({data.data() + sent, count}).take()));
    sent += count;
  } while (sent < data.size());
  return bytes;
}

}  // namespace

Expected<std::optional<Request>> RequestAssembler::add(const Packet& packet) {
  switch (packet.type) {
    case PacketType::operation_request:
      return begin(packet);
    case PacketType::start_data:
    case PacketType::data:
    case PacketType::end_data:
      return add_data(packet);
    case PacketType::cancel_transaction:
      waiting_.reset();
      return std::nullopt;
    default:
      return device_error("an unexpected packet on the command connection");
  }
}

Expected<std::optional<Request>> RequestAssembler::begin(const Packet& packet) {
  if (waiting_) return device_error("a request before the data of the last one");
  DatasetReader reader(packet.payload);
  const auto data_phase = reader.get<std::uint32_t>();
  const auto operation = reader.get<Operation>();
  const auto transaction = reader.get<std::uint32_t>();
  if (!data_phase || !operation || !transaction) return device_error("a truncated request");
  Request request;
  request.operation = *operation;
  request.transaction = *transaction;
  for (std::uint32_t& parameter : request.parameters) parameter = reader.get<std::uint32_t>().value_or(0);
  if (*data_phase != data_phase_out) return request;
  waiting_ = std::move(request);
  data_started_ = false;
  return std::nullopt;
}

Expected<std::optional<Request>> RequestAssembler::add_data(const Packet& packet) {
  DatasetReader reader(packet.payload);
  const auto transaction = reader.get<std::uint32_t>();
  const bool starts = packet.type == PacketType::start_data;
  if (!waiting_ || transaction != waiting_->transaction || starts == data_started_)
    return device_error("data that no request announced");
  if (starts) {
    data_started_ = true;
    return std::nullopt;
  }
  const auto data = reader.rest();
  if (waiting_->data.size() + data.size() > PacketStream::longest) return device_error("too much data");
  waiting_->data.insert(waiting_->data.end(), data.begin(), data.end());
  if (packet.type == PacketType::data) return std::nullopt;
  return std::exchange(waiting_, std::nullopt);
}

Bytes encode(const Response& response, std::uint32_t transaction) {
  Bytes bytes;
  if (response.data) bytes = data_packets(*response.data, transaction);
  DatasetWriter writer;
  writer.put(response.code).put(transaction);
  for (const std::uint32_t parameter : response.parameters) writer.put(parameter);
  append(bytes, encode(PacketType::operation_response, writer.bytes()));
  return bytes;
}

Bytes encode(const Event& event) {
  return encode(PacketType::event,
                DatasetWriter().put(event.code).put(std::uint32_t{0}).put(event.parameter).take());
}

}  // namespace bodyscan::simulator::ptp
