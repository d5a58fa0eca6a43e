#include "hal/virtual_projector/virtual_projector.hpp"

#include "hal/clock.hpp"
#include "tests/hal/virtual_projector/fake_projector.hpp"
#include "tests/support/temporary_folder.hpp"

#include <algorithm>
#include <future>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sys/socket.h>

namespace bodyscan {
namespace {

using virtual_projector::Flip;
using virtual_projector::Flipped;
using virtual_projector::Hello;

constexpr DisplayMode mode{{8, 4}, 60};

Hello make_hello(std::string_view edid = "NEC 4a21 1234567") {
  Hello hello;
  hello.width = static_cast<std::uint32_t>(mode.size.width);
  hello.height = static_cast<std::uint32_t>(mode.size.height);
  hello.refresh_mhz = static_cast<std::uint32_t>(mode.refresh_hz * 1000);
  std::copy(edid.begin(), edid.end(), hello.edid);
  return hello;
}

// Every pixel another value.
GrayImage8 drawing(std::uint8_t start) {
  GrayImage8 picture(mode.size);
  for (std::uint8_t& pixel : picture.pixels()) pixel = start++;
  return picture;
}

std::vector<std::uint8_t> pixels(const GrayImage8& picture) {
  return {picture.pixels().begin(), picture.pixels().end()};
}

// Until the client goes.
void listen_to(int client) {
  while (FakeProjector::next(client)) continue;
}

std::ptrdiff_t open_descriptors() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
}

class VirtualProjectorTest : public testing::Test {
 protected:
  // Without what stands in front of it.
  template <class Value>
  [[nodiscard]] std::string message(const Expected<Value>& answer) const {
    if (answer) return "done";
    EXPECT_EQ(answer.error().kind, ErrorKind::device);
    const std::string start = "projector at " + socket_.string() + ": ";
    EXPECT_EQ(answer.error().message.substr(0, start.size()), start);
    return answer.error().message.substr(std::min(start.size(), answer.error().message.size()));
  }

  [[nodiscard]] std::string open_message(const Behaviour& behaviour, const ProjectorChoice& choice) const {
    std::filesystem::remove(socket_);
    const FakeServer server(socket_, {behaviour});
    VirtualProjector projector(socket_, choice);
    std::string answer = message(projector.open());
    EXPECT_EQ(message(projector.show(drawing(0))), answer == "done" ? "done" : "is closed, not open");
    return answer;
  }

  [[nodiscard]] Behaviour sound() {
    return [this](int client) { fake_.serve(client); };
  }

  TemporaryFolder folder_;
  const std::filesystem::path socket_ = folder_ / "projector";
  FakeProjector fake_{make_hello()};
  const ProjectorChoice choice_{"", "", mode};
};

TEST_F(VirtualProjectorTest, ShowsWhatIsDrawnInAlternatingBuffers) {
  const FakeServer server(socket_, {sound()});
  VirtualProjector projector(socket_, choice_);
  EXPECT_EQ(projector.mode(), mode);
  ASSERT_TRUE(projector.open());
  const std::vector<FakeProjector::Shown> dark = fake_.shown();
  ASSERT_EQ(dark.size(), 1U);
  EXPECT_EQ(dark[0].picture, pixels(GrayImage8(mode.size, 0)));
  std::uint32_t buffer = dark[0].buffer;
  for (int i = 0; i < 5; ++i) {
    const GrayImage8 picture = drawing(static_cast<std::uint8_t>(40 * i));
    const auto time_us = projector.show(picture);
    const std::vector<FakeProjector::Shown> shown = fake_.shown();
    ASSERT_EQ(shown.size(), 1U);
    EXPECT_EQ(time_us, shown[0].time_us);
    EXPECT_EQ(shown[0].picture, pixels(picture));
    EXPECT_EQ(shown[0].buffer, 1 - buffer);
    buffer = shown[0].buffer;
  }
}

TEST_F(VirtualProjectorTest, CloseLeavesItDark) {
  const FakeServer server(socket_, {sound()});
  VirtualProjector projector(socket_, choice_);
  ASSERT_TRUE(projector.open());
  ASSERT_TRUE(projector.show(GrayImage8(mode.size, 255)));
  projector.close();
  EXPECT_EQ(fake_.shown().back().picture, pixels(GrayImage8(mode.size, 0)));
  projector.close();
  EXPECT_TRUE(fake_.shown().empty());
  EXPECT_EQ(message(projector.show(drawing(0))), "is closed, not open");
  {
    VirtualProjector forgotten(socket_, choice_);
    ASSERT_TRUE(forgotten.open());
    ASSERT_TRUE(forgotten.show(GrayImage8(mode.size, 255)));
  }
  EXPECT_EQ(fake_.shown().back().picture, pixels(GrayImage8(mode.size, 0)));
}

TEST_F(VirtualProjectorTest, APictureOfAnotherSizeIsRefused) {
  const FakeServer server(socket_, {sound()});
  VirtualProjector projector(socket_, choice_);
  ASSERT_TRUE(projector.open());
  EXPECT_EQ(message(projector.show(GrayImage8({4, 8}, 0))), "a picture of another size than its mode");
  EXPECT_TRUE(projector.show(drawing(0)));
}

TEST_F(VirtualProjectorTest, IdentifyTellsWhoIsThere) {
  const FakeServer server(socket_, {sound()});
  const auto output = VirtualProjector::identify(socket_);
  ASSERT_TRUE(output) << output.error().message;
  EXPECT_EQ(output->connector, socket_.string());
  EXPECT_EQ(output->edid, "NEC 4a21 1234567");
  EXPECT_EQ(output->modes, std::vector{mode});
}

TEST_F(VirtualProjectorTest, TheRightEdidOpens) {
  EXPECT_EQ(open_message(sound(), {"", "NEC 4a21 1234567", mode}), "done");
  const std::string longest(sizeof(Hello::edid), 'x');  // no zero behind it
  FakeProjector fake(make_hello(longest));
  EXPECT_EQ(open_message([&](int client) { fake.serve(client); }, {"", longest, mode}), "done");
}

TEST_F(VirtualProjectorTest, AnotherModeOrEdidIsRefused) {
  EXPECT_EQ(open_message(sound(), {"", "", {{1024, 768}, 60}}),
            "its mode is 8 x 4 at 60 Hz, the calibration needs 1024 x 768 at 60 Hz: set that mode, or "
            "calibrate anew");
  EXPECT_EQ(open_message(sound(), {"", "", {{8, 4}, 59.94}}),
            "its mode is 8 x 4 at 60 Hz, the calibration needs 8 x 4 at 59.94 Hz: set that mode, or "
            "calibrate anew");
  EXPECT_EQ(open_message(sound(), {"", "EPS 1 2", mode}),
            "it is 'NEC 4a21 1234567', not the 'EPS 1 2' of the rig file");
}

TEST_F(VirtualProjectorTest, NobodyThereIsADeviceError) {
  VirtualProjector projector(socket_, choice_);
  EXPECT_EQ(message(projector.show(drawing(0))), "is closed, not open");
  EXPECT_EQ(message(projector.open()), "not there: No such file or directory");
  EXPECT_EQ(message(VirtualProjector::identify(socket_)), "not there: No such file or directory");
  const std::filesystem::path endless = folder_ / std::string(200, 'x');
  EXPECT_EQ(VirtualProjector::identify(endless).error().message,
            "projector at " + endless.string() + ": the socket's name is too long");
}

TEST_F(VirtualProjectorTest, GarbageIsNoProjector) {
  const auto greeted_with = [&](const Hello& hello, std::size_t bytes, const std::vector<int>& descriptors) {
    return open_message(
        [&](int client) {
          send_with(client, &hello, bytes, descriptors);
          listen_to(client);
        },
        choice_);
  };
  const std::ptrdiff_t before = open_descriptors();
  const std::vector memory{fake_.memory()};
  const Hello good = make_hello();
  const std::string refused = "is no virtual projector";
  Hello hello = good;
  hello.magic = 7;
  EXPECT_EQ(greeted_with(hello, sizeof hello, memory), refused);
  EXPECT_EQ(greeted_with(good, sizeof good - 1, memory), refused);
  EXPECT_EQ(greeted_with(good, sizeof good, {}), refused);
  for (const std::uint32_t side : {0U, 16385U, 4294967295U}) {
    hello = good;
    hello.width = side;
    EXPECT_EQ(greeted_with(hello, sizeof hello, memory), refused) << side;
    hello = good;
    hello.height = side;
    EXPECT_EQ(greeted_with(hello, sizeof hello, memory), refused) << side;
  }
  EXPECT_EQ(open_message([](int) {}, choice_), refused);  // closes at once
  for (std::size_t more = 2; more <= 8; ++more)
    EXPECT_EQ(greeted_with(good, sizeof good, std::vector<int>(more, fake_.memory())), refused) << more;
  EXPECT_EQ(open_descriptors(), before);
}

TEST_F(VirtualProjectorTest, TooSmallMemoryIsRefused) {
  const std::string refused = "its memory does not hold two pictures";
  for (const std::size_t bytes : {std::size_t{0}, 2 * mode.size.area() - 1}) {
    FakeProjector fake(make_hello(), bytes);
    EXPECT_EQ(open_message([&](int client) { fake.serve(client); }, choice_), refused) << bytes;
  }
  const auto without_memory = [](int client) {
    const Hello hello = make_hello();
    send_with(client, &hello, sizeof hello, {client});
    listen_to(client);
  };
  EXPECT_EQ(open_message(without_memory, choice_), refused);
}

TEST_F(VirtualProjectorTest, ALostProjectorMayBeOpenedAgain) {
  const FakeServer server(socket_, {[&](int client) { fake_.serve(client, 2); }, sound()});
  VirtualProjector projector(socket_, choice_);
  ASSERT_TRUE(projector.open());
  ASSERT_TRUE(projector.show(drawing(1)));
  EXPECT_EQ(message(projector.show(drawing(2))), "was unplugged: check its cable and power");
  EXPECT_EQ(message(projector.show(drawing(2))), "was lost and must be opened again");
  ASSERT_TRUE(projector.open());
  EXPECT_TRUE(projector.show(drawing(3)));
  EXPECT_EQ(fake_.shown().back().picture, pixels(drawing(3)));
}

TEST_F(VirtualProjectorTest, CloseIsLegalWhenItWasLost) {
  const FakeServer server(socket_, {[&](int client) { fake_.serve(client, 1); }, sound()});
  VirtualProjector projector(socket_, choice_);
  ASSERT_TRUE(projector.open());
  projector.close();  // notices it only now
  ASSERT_TRUE(projector.open());
  EXPECT_TRUE(projector.show(drawing(3)));
}

TEST_F(VirtualProjectorTest, AnAnswerThatIsNoneIsALoss) {
  const auto half = [&](int client) {
    fake_.serve(client, 1);
    FakeProjector::next(client);
    const std::uint32_t sequence = 2;
    send_with(client, &sequence, sizeof sequence, {});
    listen_to(client);
  };
  const FakeServer server(socket_, {half});
  VirtualProjector projector(socket_, choice_);
  ASSERT_TRUE(projector.open());
  EXPECT_EQ(message(projector.show(drawing(2))), "was unplugged: check its cable and power");
}

TEST_F(VirtualProjectorTest, AnAnswerToAnEarlierFlipIsPassedOver) {
  const auto late = [&](int client) {
    fake_.greet(client);
    while (const std::optional<Flip> flip = FakeProjector::next(client)) {
      for (const std::uint32_t sequence : {flip->sequence - 1, flip->sequence}) {
        const Flipped flipped{sequence, 0, 100 * sequence};
        send_with(client, &flipped, sizeof flipped, {});
      }
    }
  };
  const FakeServer server(socket_, {late});
  VirtualProjector projector(socket_, choice_);
  ASSERT_TRUE(projector.open());
  EXPECT_EQ(projector.show(drawing(2)), 200);
  EXPECT_EQ(projector.show(drawing(3)), 300);
}

// Each waits for its second, all at once.
TEST_F(VirtualProjectorTest, WhoDoesNotAnswerIsGivenUpAfterASecond) {
  const auto flood = [](int client) {
    FakeProjector fake(make_hello());
    fake.serve(client, 1);
    const Flipped other{77, 0, 0};
    while (send(client, &other, sizeof other, MSG_NOSIGNAL) > 0) continue;
  };
  const auto deaf = [&](int client) {
    fake_.serve(client, 1);
    listen_to(client);
  };
  struct Case {
    std::filesystem::path socket;
    Behaviour behaviour;
    std::string message;
    std::int64_t took_us = 0;
  };
  Case cases[] = {{folder_ / "mute", listen_to, "does not answer"},
                  {folder_ / "deaf", deaf, "does not show the picture: check its cable and power"},
                  {folder_ / "flood", flood, "does not show the picture: check its cable and power"}};
  std::vector<std::future<std::string>> answers;
  for (Case& one : cases)
    answers.push_back(std::async(std::launch::async, [&] {
      const FakeServer server(one.socket, {one.behaviour});
      VirtualProjector projector(one.socket, choice_);
      const std::int64_t start_us = monotonic_us();
      const auto shown = projector.open().and_then([&] { return projector.show(drawing(1)); });
      one.took_us = monotonic_us() - start_us;
      return shown ? "done" : shown.error().message;
    }));
  for (std::size_t i = 0; i < std::size(cases); ++i) {
    EXPECT_EQ(answers[i].get(), "projector at " + cases[i].socket.string() + ": " + cases[i].message);
    EXPECT_NEAR(static_cast<double>(cases[i].took_us), 1e6, 3e5) << cases[i].socket;
  }
}

TEST_F(VirtualProjectorTest, AProjectorThatTakesNoMoreClientsDoesNotAnswer) {
  std::promise<void> end;
  const auto busy = [&](int) { end.get_future().wait(); };
  const FakeServer server(socket_, {busy, [](int) {}});
  std::vector<std::future<std::string>> answers;
  for (int i = 0; i < 4; ++i)
    answers.push_back(
        std::async(std::launch::async, [&] { return message(VirtualProjector::identify(socket_)); }));
  bool all = true;
  for (auto& answer : answers) all &= answer.wait_for(std::chrono::seconds(2)) == std::future_status::ready;
  EXPECT_TRUE(all);
  end.set_value();
  for (auto& answer : answers) EXPECT_EQ(answer.get(), "does not answer");
}

TEST_F(VirtualProjectorTest, OpenAndCloseLeakNothing) {
  const FakeServer server(socket_, {sound()});
  VirtualProjector projector(socket_, choice_);
  const auto once = [&] {
    ASSERT_TRUE(projector.open());
    ASSERT_TRUE(projector.show(drawing(1)));
    projector.close();
    // The server lets go of one client before it greets the next.
    ASSERT_TRUE(VirtualProjector::identify(socket_));
  };
  const std::ptrdiff_t before = open_descriptors();
  for (int i = 0; i < 20; ++i) once();
  // At most the client that is going.
  EXPECT_LE(open_descriptors(), before + 1);
}

}  // namespace
}  // namespace bodyscan
