#include "hal/gphoto2/worker_message.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace bodyscan::gphoto2 {
namespace {

std::vector<Reply> sample_replies() {
  return {CamerasFound{{{"Nikon DSC D5000 (PTP mode)", "usb:001,004"}, {"", "usb:001,005"}}},
          Opened{{"D5000", "1234567", {"the mode dial is not on M: turn it to M"}}, "usb:001,004"},
          Configured{{50'000, 200, 8, {4288, 2848}}},
          Exposed{},
          Progress{},
          PictureReady{4'498'390, 123'456'789'012},
          Failure{true, "reading: I/O problem"}};
}

std::vector<Request> sample_requests() {
  return {ListCameras{},
          OpenCamera{"ptpip:127.0.0.1:15740:15740"},
          Configure{{66'667, 400, 5.6, {}}},
          Expose{},
          Fetch{},
          Preview{}};
}

TEST(WorkerMessage, RequestsArriveAsTheyWereSent) {
  for (const Request& request : sample_requests()) {
    const auto bytes = encode(7, request);
    const auto decoded = decode_request(bytes);
    ASSERT_TRUE(decoded) << request.index();
    EXPECT_EQ(decoded->number, 7U);
    EXPECT_EQ(decoded->message.index(), request.index());
    EXPECT_EQ(encode(7, decoded->message), bytes);
  }
}

TEST(WorkerMessage, RepliesArriveAsTheyWereSent) {
  for (const Reply& reply : sample_replies()) {
    const auto bytes = encode(4'000'000'000U, reply);
    const auto decoded = decode_reply(bytes);
    ASSERT_TRUE(decoded) << reply.index();
    EXPECT_EQ(decoded->number, 4'000'000'000U);
    EXPECT_EQ(decoded->message.index(), reply.index());
    EXPECT_EQ(encode(4'000'000'000U, decoded->message), bytes);
  }
}

TEST(WorkerMessage, EveryTruncationAndEveryAdditionIsRefused) {
  for (const Reply& reply : sample_replies()) {
    auto bytes = encode(7, reply);
    for (std::size_t length = 0; length < bytes.size(); ++length)
      EXPECT_FALSE(decode_reply(std::span(bytes).first(length))) << reply.index() << ": " << length;
    bytes.push_back(std::byte{0});
    EXPECT_FALSE(decode_reply(bytes)) << reply.index();
  }
}

TEST(WorkerMessage, UnknownKindsAreRefused) {
  auto bytes = encode(7, Reply(Exposed{}));
  for (const std::uint32_t kind : {7U, 8U, 0xffff'ffffU}) {
    std::memcpy(bytes.data() + 4, &kind, sizeof kind);
    EXPECT_FALSE(decode_reply(bytes)) << kind;
  }
}

TEST(WorkerMessage, LengthsBeyondTheMessageAreRefused) {
  for (const Reply& reply :
       {Reply(CamerasFound{{{"model", "port"}}}), Reply(Opened{{"D5000", "", {}}, ""})}) {
    auto bytes = encode(7, reply);
    for (const std::uint32_t length : {33U, 513U, 0x7fff'ffffU, 0xffff'ffffU}) {
      std::memcpy(bytes.data() + 8, &length, sizeof length);
      EXPECT_FALSE(decode_reply(bytes)) << length;
    }
  }
}

TEST(WorkerMessage, ImpossibleNumbersAreRefused) {
  const double nan = std::nan("");
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<CameraSettings> settings = {
      {0, 200, 8, {}},        {-1, 200, 8, {}}, {1, -1, 8, {}},         {1, 200, nan, {}},
      {1, 200, infinity, {}}, {1, 200, -1, {}}, {1, 200, 8, {-1, 100}}, {1, 200, 8, {100, 100'001}},
  };
  for (const CameraSettings& wrong : settings) {
    EXPECT_FALSE(decode_reply(encode(7, Reply(Configured{wrong}))));
    EXPECT_FALSE(decode_request(encode(7, Request(Configure{wrong}))));
  }
  EXPECT_FALSE(decode_reply(encode(7, Reply(PictureReady{0, 1}))));
  EXPECT_FALSE(decode_reply(encode(7, Reply(PictureReady{max_picture_bytes + 1, 1}))));
  EXPECT_FALSE(decode_reply(encode(7, Reply(PictureReady{1, -1}))));
}

TEST(WorkerMessage, AFlagIsZeroOrOne) {
  auto bytes = encode(7, Reply(Failure{true, "gone"}));
  bytes[8] = std::byte{2};
  EXPECT_FALSE(decode_reply(bytes));
}

TEST(WorkerMessage, TextsCannotMoveTheCursorOfATerminal) {
  const auto decoded = decode_reply(encode(7, Reply(Failure{false, "a\x1b[2J\r\nb\x7f"})));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(std::get<Failure>(decoded->message).message, "a [2J  b ");
}

TEST(WorkerMessage, LongTextsAndListsAreCutToFit) {
  Opened opened{{std::string(10'000, 'm'), "", std::vector<std::string>(100, std::string(1'000, 'p'))}, ""};
  const auto bytes = encode(7, Reply(opened));
  EXPECT_LE(bytes.size(), max_message_bytes);
  const auto decoded = decode_reply(bytes);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(std::get<Opened>(decoded->message).identity.model.size(), 512U);
  EXPECT_EQ(std::get<Opened>(decoded->message).identity.problems.size(), 32U);
  const CamerasFound many{std::vector<FoundCamera>(100, {std::string(1'000, 'm'), std::string(1'000, 'p')})};
  EXPECT_LE(encode(7, Reply(many)).size(), max_message_bytes);
}

TEST(WorkerMessage, AnyBytesAreRefusedOrUnderstood) {
  std::mt19937 random(1);
  const std::vector<Reply> replies = sample_replies();
  for (int round = 0; round < 100'000; ++round) {
    auto bytes = encode(7, replies[random() % replies.size()]);
    for (unsigned changes = random() % 4; changes > 0; --changes)
      bytes[random() % bytes.size()] = static_cast<std::byte>(random());
    bytes.resize(random() % 8 == 0 ? random() % (bytes.size() + 20) : bytes.size());
    if (const auto decoded = decode_reply(bytes)) {
      EXPECT_LE(encode(7, decoded->message).size(), max_message_bytes);
    }
    (void)decode_request(bytes);
  }
}

}  // namespace
}  // namespace bodyscan::gphoto2
