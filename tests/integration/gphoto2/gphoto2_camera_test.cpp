// The camera through libgphoto2 itself, against the simulated world.
#include "hal/gphoto2/gphoto2_camera.hpp"

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace bodyscan::gphoto2 {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

// `bodyscan-simulator serve` for as long as this lives.
class World {
 public:
  explicit World(const std::vector<std::string>& more = {}) {
    const std::string socket = testing::TempDir() + "/projector-" + std::to_string(::getpid());
    std::vector<std::string> words = {BODYSCAN_SIMULATOR, "serve",        "--subject", "builtin:staircase",
                                      "--calibration",    "builtin:rows", "--scale",   "0.1",
                                      "--projector",      socket,         "--port",    "0"};
    words.insert(words.end(), more.begin(), more.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    std::array<int, 2> output{};
    EXPECT_EQ(::pipe(output.data()), 0);
    process_ = ::fork();
    if (process_ == 0) {
      ::dup2(output[1], STDOUT_FILENO);
      ::close(output[0]);
      ::close(output[1]);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    ::close(output[1]);
    std::string line;
    for (char character = 0; ::read(output[0], &character, 1) == 1 && character != '\n';) line += character;
    ::close(output[0]);
    std::string ready;
    std::istringstream(line) >> ready >> port_;
    EXPECT_EQ(ready, "ready") << line;
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World() {
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }

  [[nodiscard]] Gphoto2Options camera() const {
    Gphoto2Options options;
    options.port = port_;
    options.worker.executable = BODYSCAN_EXECUTABLE;
    return options;
  }

 private:
  pid_t process_ = -1;
  std::string port_;
};

bool is_jpeg(const Photograph& photograph) {
  return photograph.file.size() > 4 && photograph.file[0] == std::byte{0xff} &&
         photograph.file[1] == std::byte{0xd8};
}

std::int64_t now_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(steady_clock::now().time_since_epoch())
      .count();
}

TEST(Gphoto2CameraAndLibgphoto2, IdentifiesSetsAndPhotographs) {
  const World world;
  Gphoto2Camera camera(world.camera());
  const auto identity = camera.open();
  ASSERT_TRUE(identity) << identity.error().message;
  EXPECT_EQ(identity->model, "D5000");
  EXPECT_FALSE(identity->serial.empty());
  EXPECT_EQ(identity->problems, std::vector<std::string>());
  const auto settings = camera.configure({51'000, 210, 7.9, {}});
  ASSERT_TRUE(settings) << settings.error().message;
  EXPECT_EQ(*settings, (CameraSettings{50'000, 200, 8, settings->picture}));
  EXPECT_GT(settings->picture.width, 400);
  EXPECT_FALSE(camera.configure({50'000, 200, 8, {17, 4}}));
  for (int shot = 0; shot < 3; ++shot) {
    const std::int64_t before = now_us();
    const auto exposed = camera.expose();
    ASSERT_TRUE(exposed) << exposed.error().message;
    const std::int64_t after = now_us();
    const auto picture = camera.fetch();
    ASSERT_TRUE(picture) << picture.error().message;
    EXPECT_TRUE(is_jpeg(*picture));
    EXPECT_GE(picture->exposure_end_us, before + 50'000);
    EXPECT_LE(picture->exposure_end_us, after);
    const auto preview = camera.preview();
    ASSERT_TRUE(preview) << preview.error().message;
    EXPECT_TRUE(is_jpeg(*preview));
  }
}

TEST(Gphoto2CameraAndLibgphoto2, ADialThatIsNotOnMIsToldAndRefused) {
  const World world({"--fault", "dial"});
  Gphoto2Camera camera(world.camera());
  const auto identity = camera.open();
  ASSERT_TRUE(identity) << identity.error().message;
  EXPECT_EQ(identity->problems, std::vector<std::string>{"the mode dial is not on M: turn it to M"});
  const auto settings = camera.configure({});
  ASSERT_FALSE(settings);
  EXPECT_TRUE(settings.error().message.ends_with(": the mode dial is not on M: turn it to M"));
}

// Loses the camera at its second shot, within the exposure and two seconds, and gets it back.
void lose_and_recover(const std::string& fault) {
  const World world({"--fault", fault});
  Gphoto2Camera camera(world.camera());
  ASSERT_TRUE(camera.open());
  ASSERT_TRUE(camera.configure({}));
  ASSERT_TRUE(camera.expose() && camera.fetch());
  const auto start = steady_clock::now();
  auto exposed = camera.expose();
  const auto picture = exposed ? camera.fetch() : tl::unexpected(exposed.error());
  ASSERT_FALSE(picture);
  EXPECT_LT(steady_clock::now() - start, milliseconds(50 + 2'000 + 500)) << picture.error().message;
  EXPECT_TRUE(picture.error().message.starts_with("camera D5000 at ptpip:"));
  EXPECT_TRUE(picture.error().message.ends_with(": switch it off and on, check the cable"))
      << picture.error().message;
  EXPECT_EQ(camera.worker_pid(), -1);
  const auto again = camera.open();
  ASSERT_TRUE(again) << again.error().message;
  ASSERT_TRUE(camera.configure({}));
  ASSERT_TRUE(camera.expose());
  EXPECT_TRUE(camera.fetch());
}

TEST(Gphoto2CameraAndLibgphoto2, AFrozenCameraIsLostInTimeAndOpensAgain) {
  lose_and_recover("frozen@2");
}

TEST(Gphoto2CameraAndLibgphoto2, ADisconnectedCameraIsLostInTimeAndOpensAgain) {
  lose_and_recover("disconnect@2");
}

TEST(Gphoto2CameraAndLibgphoto2, AKilledWorkerLosesTheCameraAndItOpensAgain) {
  const World world;
  Gphoto2Camera camera(world.camera());
  ASSERT_TRUE(camera.open());
  ::kill(camera.worker_pid(), SIGKILL);
  EXPECT_FALSE(camera.expose());
  ASSERT_TRUE(camera.open());
  EXPECT_TRUE(camera.expose() && camera.fetch());
}

}  // namespace
}  // namespace bodyscan::gphoto2
