#include "tools/simulator/serve/projector_server.hpp"

#include "projector_client.hpp"
#include "running_loop.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_files.hpp"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

namespace bodyscan::simulator {
namespace {

namespace wire = virtual_projector;
using std::chrono::milliseconds;

constexpr Size panel{64, 48};

class ProjectorServerTest : public testing::Test {
 protected:
  ProjectorServerTest() { running_.start(); }
  ~ProjectorServerTest() override { running_.stop(); }

  struct Shown {
    Picture picture;
    Moment moment;
  };
  std::vector<Shown> shown() {
    std::vector<Shown> copy;
    running_.on_loop([&] { copy = shown_; });
    return copy;
  }

  TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "projector";
  std::vector<Shown> shown_;
  RunningLoop running_;
  std::unique_ptr<ProjectorServer> server_ =
      ProjectorServer::open(path_, panel, running_.loop(), [this](Picture picture, Moment moment) {
        shown_.push_back({std::move(picture), moment});
      }).value();
};

TEST_F(ProjectorServerTest, GreetsWithItsModeAndTwoBlackPictures) {
  ProjectorClient client(path_);
  const wire::Hello hello = client.greet();
  EXPECT_EQ(hello.magic, wire::magic);
  EXPECT_EQ(hello.width, 64U);
  EXPECT_EQ(hello.height, 48U);
  EXPECT_EQ(hello.refresh_mhz, 60'000U);
  EXPECT_STRNE(hello.edid, "");
  struct stat status {};
  ASSERT_EQ(fstat(client.memory_fd(), &status), 0);
  EXPECT_EQ(status.st_size, 2 * 64 * 48);
  EXPECT_NE(ftruncate(client.memory_fd(), 1), 0);
}

TEST_F(ProjectorServerTest, AFlipIsDoneAtTheNextFrameBoundary) {
  ProjectorClient client(path_);
  client.greet();
  std::vector<std::int64_t> times;
  for (std::uint32_t i = 0; i < 6; ++i) {
    client.draw((i + 1) % 2, static_cast<std::uint8_t>(40 * i));
    const Moment before = Clock::now();
    const wire::Flipped flipped = client.flip((i + 1) % 2, 100 + i);
    EXPECT_EQ(flipped.sequence, 100 + i);
    const Moment done = Moment(std::chrono::microseconds(flipped.time_us));
    EXPECT_GE(done, before - milliseconds(1));
    EXPECT_LE(done, Clock::now());
    times.push_back(flipped.time_us);
  }
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double frames = static_cast<double>(times[i] - times[0]) * 60e-6;
    EXPECT_NEAR(frames, std::round(frames), 0.001);
  }
  const std::vector<Shown> history = shown();
  ASSERT_EQ(history.size(), 6U);
  for (std::size_t i = 0; i < history.size(); ++i) {
    EXPECT_EQ(history[i].picture->pixels(63, 47), 40 * i);
    EXPECT_NEAR(seconds(history[i].moment.time_since_epoch()), static_cast<double>(times[i]) * 1e-6, 2e-6);
  }
}

TEST_F(ProjectorServerTest, FlipsAtOnceTakeAFrameEach) {
  ProjectorClient client(path_);
  client.greet();
  client.send(wire::Flip{0, 1});
  client.send(wire::Flip{1, 2});
  const wire::Flipped first = client.answer();
  const wire::Flipped second = client.answer();
  EXPECT_EQ(second.sequence, 2U);
  EXPECT_NEAR(static_cast<double>(second.time_us - first.time_us), 1e6 / 60, 2);
}

TEST_F(ProjectorServerTest, IsDarkOnceItsClientHasGoneAndGreetsTheNext) {
  {
    ProjectorClient client(path_);
    client.greet();
    client.draw(1, 255);
    client.flip(1, 1);
  }
  ProjectorClient next(path_);
  EXPECT_EQ(next.greet().width, 64U);
  const std::vector<Shown> history = shown();
  ASSERT_EQ(history.size(), 2U);
  EXPECT_EQ(history[1].picture->pixels(0, 0), 0);
}

TEST_F(ProjectorServerTest, WrongMessagesEndTheConnection) {
  struct Long {
    wire::Flip flip;
    int more = 0;
  };
  ProjectorClient wrong_buffer(path_);
  wrong_buffer.greet();
  wrong_buffer.send(wire::Flip{2, 1});
  EXPECT_TRUE(wrong_buffer.hung_up());
  ProjectorClient too_long(path_);
  too_long.greet();
  too_long.send(Long{});
  EXPECT_TRUE(too_long.hung_up());
  ProjectorClient too_short(path_);
  too_short.greet();
  too_short.send(std::uint32_t{1});
  EXPECT_TRUE(too_short.hung_up());
  EXPECT_EQ(ProjectorClient(path_).greet().magic, wire::magic);
}

TEST_F(ProjectorServerTest, UnpluggedItRefusesUntilItIsBack) {
  ProjectorClient client(path_);
  client.greet();
  running_.on_loop([&] { server_->unplug(Clock::now() + milliseconds(100)); });
  EXPECT_TRUE(client.hung_up());
  EXPECT_FALSE(ProjectorClient(path_).connected());
  std::this_thread::sleep_for(milliseconds(150));
  ProjectorClient again(path_);
  ASSERT_TRUE(again.connected());
  EXPECT_EQ(again.greet().width, 64U);
}

TEST_F(ProjectorServerTest, AnotherModeIsStretchedToThePanel) {
  ProjectorClient client(path_);
  client.greet();
  running_.on_loop([&] { server_->change_mode({80, 60}); });
  EXPECT_TRUE(client.hung_up());
  ProjectorClient next(path_);
  EXPECT_EQ(next.greet().width, 80U);
  next.draw(0, 99);
  next.flip(0, 1);
  const Picture picture = shown().back().picture;
  EXPECT_EQ(picture->pixels.size(), panel);
  EXPECT_EQ(picture->pixels(63, 47), 99);
}

TEST_F(ProjectorServerTest, LeavesNoSocketBehindAndTakesAnAbandonedOneOver) {
  running_.stop();
  EXPECT_TRUE(std::filesystem::exists(path_));
  EventLoop loop;
  const auto ignore = [](const Picture&, Moment) {};
  EXPECT_FALSE(ProjectorServer::open(path_, panel, loop, ignore).has_value());  // in use
  server_.reset();
  EXPECT_FALSE(std::filesystem::exists(path_));
  {
    const UniqueFd abandoned(socket(AF_UNIX, SOCK_SEQPACKET, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path_.c_str(), sizeof address.sun_path - 1);
    ASSERT_EQ(bind(abandoned.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }
  EXPECT_TRUE(ProjectorServer::open(path_, panel, loop, ignore).has_value());
  write_text(path_, "a file");
  EXPECT_FALSE(ProjectorServer::open(path_, panel, loop, ignore).has_value());
  EXPECT_EQ(read_text(path_), "a file");
  const Expected<std::unique_ptr<ProjectorServer>> too_long =
      ProjectorServer::open(std::string(200, 'x'), panel, loop, ignore);
  EXPECT_EQ(too_long.error().kind, ErrorKind::usage);
}

}  // namespace
}  // namespace bodyscan::simulator
