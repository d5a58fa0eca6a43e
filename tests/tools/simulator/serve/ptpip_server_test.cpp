#include "tools/simulator/serve/ptpip_server.hpp"

#include "camera_test_support.hpp"
#include "running_loop.hpp"

#include <random>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace bodyscan::simulator {
namespace {

using ptp::Bytes;
using ptp::DatasetWriter;
using ptp::Operation;
using ptp::Packet;
using ptp::PacketType;
using ptp::ResponseCode;

// One connection of an initiator.
class Initiator {
 public:
  explicit Initiator(int port) : fd_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(fd_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    const timeval patience{.tv_sec = 3, .tv_usec = 0};
    setsockopt(fd_.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }

  void send(const Bytes& bytes) { ::send(fd_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL); }
  // Nothing once the responder has closed the connection.
  std::optional<Packet> receive() {
    for (;;) {
      if (std::optional<Packet> packet = packets_.next().value()) return packet;
      std::array<std::uint8_t, 4096> piece;
      const ssize_t count = recv(fd_.get(), piece.data(), piece.size(), 0);
      if (count <= 0) return std::nullopt;
      packets_.append({piece.data(), static_cast<std::size_t>(count)});
    }
  }
  [[nodiscard]] bool silent_for(std::chrono::milliseconds time) const {
    pollfd descriptor{fd_.get(), POLLIN, 0};
    return poll(&descriptor, 1, static_cast<int>(time.count())) == 0;
  }

  // Becomes a command connection; its number.
  std::uint32_t introduce() {
    send(ptp::encode(PacketType::init_command_request, Bytes(16 + 2 + 4)));
    const std::optional<Packet> answer = receive();
    if (!answer || answer->type != PacketType::init_command_ack) return 0;
    ptp::DatasetReader reader(answer->payload);
    return reader.get<std::uint32_t>().value_or(0);
  }
  void request(Operation operation, std::uint32_t parameter = 0) {
    send(ptp::encode(
        PacketType::operation_request,
        DatasetWriter().put(std::uint32_t{1}).put(operation).put(++transaction_).put(parameter).bytes()));
  }
  std::optional<ResponseCode> execute(Operation operation, std::uint32_t parameter = 0) {
    request(operation, parameter);
    while (const std::optional<Packet> packet = receive()) {
      if (packet->type != PacketType::operation_response) continue;
      ptp::DatasetReader reader(packet->payload);
      return reader.get<ResponseCode>();
    }
    return std::nullopt;
  }

 private:
  UniqueFd fd_;
  ptp::PacketStream packets_;
  std::uint32_t transaction_ = 0;
};

class PtpIpServerTest : public testing::Test {
 protected:
  explicit PtpIpServerTest(std::vector<Fault> faults = {})
      : camera_({2144, 1424}, Faults(std::move(faults)), darkroom_) {
    server_ = PtpIpServer::open(0, running_.loop(), camera_).value();
    running_.start();
  }
  ~PtpIpServerTest() override { running_.stop(); }

  FakeDarkroom darkroom_;
  Camera camera_;
  RunningLoop running_;
  std::unique_ptr<PtpIpServer> server_;
};

TEST_F(PtpIpServerTest, ServesInitiatorsOneAfterTheOther) {
  for (std::uint32_t number = 1; number <= 3; ++number) {
    Initiator initiator(server_->port());
    EXPECT_EQ(initiator.introduce(), number);
    EXPECT_EQ(initiator.execute(Operation::open_session, 1), ResponseCode::ok);
    EXPECT_EQ(initiator.execute(Operation::get_device_info), ResponseCode::ok);
  }
}

TEST_F(PtpIpServerTest, ANewInitiatorTakesThePlaceOfTheLast) {
  Initiator first(server_->port());
  first.introduce();
  Initiator second(server_->port());
  second.introduce();
  EXPECT_FALSE(first.receive());
  EXPECT_EQ(second.execute(Operation::open_session, 1), ResponseCode::ok);
}

TEST_F(PtpIpServerTest, AShotOntoTheCardTellsOnTheEventConnection) {
  Initiator command(server_->port());
  const std::uint32_t number = command.introduce();
  Initiator event(server_->port());
  event.send(ptp::encode(PacketType::init_event_request, DatasetWriter().put(number).bytes()));
  EXPECT_EQ(event.receive()->type, PacketType::init_event_ack);
  command.execute(Operation::open_session, 1);
  EXPECT_EQ(command.execute(Operation::initiate_capture), ResponseCode::ok);
  EXPECT_EQ(event.receive()->type, PacketType::event);
  EXPECT_EQ(event.receive()->type, PacketType::event);
}

TEST_F(PtpIpServerTest, AnEventConnectionOfNobodyIsClosed) {
  Initiator event(server_->port());
  event.send(ptp::encode(PacketType::init_event_request, DatasetWriter().put(std::uint32_t{77}).bytes()));
  EXPECT_FALSE(event.receive());
}

TEST_F(PtpIpServerTest, ProbesAreAnswered) {
  Initiator initiator(server_->port());
  initiator.introduce();
  initiator.send(ptp::encode(PacketType::probe_request, {}));
  EXPECT_EQ(initiator.receive()->type, PacketType::probe_response);
}

TEST_F(PtpIpServerTest, GarbageEndsItsConnectionOnly) {
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    Initiator initiator(server_->port());
    if (round % 2 == 0) initiator.introduce();
    Bytes garbage(random() % 200 + 8);
    for (std::uint8_t& byte : garbage) byte = static_cast<std::uint8_t>(random());
    if (round % 4 < 2) {  // a packet that is well-formed on the outside
      garbage = ptp::encode(static_cast<PacketType>(random() % 16), garbage);
    }
    initiator.send(garbage);
  }
  Initiator initiator(server_->port());
  EXPECT_NE(initiator.introduce(), 0U);
  EXPECT_EQ(initiator.execute(Operation::open_session, 1), ResponseCode::ok);
}

TEST_F(PtpIpServerTest, ParametersOfEveryKindAreSurvived) {
  Initiator initiator(server_->port());
  initiator.introduce();
  initiator.execute(Operation::open_session, 1);
  for (int operation = 0x1001; operation < 0x1020; ++operation) {
    if (operation == static_cast<int>(Operation::close_session)) continue;
    for (const std::uint32_t parameter : {0U, 1U, 0x7FFFFFFFU, 0xFFFFFFFFU, 0x500DU})
      EXPECT_TRUE(initiator.execute(static_cast<Operation>(operation), parameter)) << operation;
  }
}

class DisconnectingServer : public PtpIpServerTest {
 protected:
  DisconnectingServer() : PtpIpServerTest({{FaultKind::disconnect, 1, 0}}) {}
};
TEST_F(DisconnectingServer, ClosesInMidExposureAndTakesANewConnection) {
  Initiator initiator(server_->port());
  initiator.introduce();
  initiator.execute(Operation::open_session, 1);
  EXPECT_EQ(initiator.execute(Operation::nikon_initiate_capture_rec_in_sdram), ResponseCode::ok);
  EXPECT_FALSE(initiator.receive());
  Initiator again(server_->port());
  EXPECT_NE(again.introduce(), 0U);
}

class FreezingServer : public PtpIpServerTest {
 protected:
  FreezingServer() : PtpIpServerTest({{FaultKind::frozen, 1, 0}, {FaultKind::frozen_for_good, 2, 0}}) {}
};
TEST_F(FreezingServer, IsSilentUntilANewConnectionThenForGood) {
  Initiator initiator(server_->port());
  initiator.introduce();
  initiator.execute(Operation::open_session, 1);
  initiator.request(Operation::nikon_initiate_capture_rec_in_sdram);
  initiator.request(Operation::get_device_info);
  EXPECT_TRUE(initiator.silent_for(std::chrono::milliseconds(50)));
  Initiator again(server_->port());
  EXPECT_NE(again.introduce(), 0U);
  EXPECT_EQ(again.execute(Operation::open_session, 1), ResponseCode::ok);
  again.request(Operation::nikon_initiate_capture_rec_in_sdram);
  EXPECT_TRUE(again.silent_for(std::chrono::milliseconds(50)));
  Initiator last(server_->port());
  last.send(ptp::encode(PacketType::init_command_request, Bytes(16 + 2 + 4)));
  EXPECT_TRUE(last.silent_for(std::chrono::milliseconds(50)));
}

}  // namespace
}  // namespace bodyscan::simulator
