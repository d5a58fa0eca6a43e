#include "hal/gphoto2/gphoto2_camera.hpp"

#include "process_counts.hpp"

#include <csignal>
#include <cstdlib>
#include <optional>
#include <random>
#include <thread>

#include <gtest/gtest.h>

namespace bodyscan::gphoto2 {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

// Long enough for a busy machine to answer in, short enough to wait for.
constexpr Deadlines short_deadlines{milliseconds(3'000), milliseconds(400), milliseconds(350),
                                    milliseconds(300),   milliseconds(300), milliseconds(200),
                                    milliseconds(900)};

Gphoto2Options with(std::vector<std::string> behaviours) {
  return {"usb:001,004", {BODYSCAN_FAKE_WORKER, std::move(behaviours), ""}, short_deadlines};
}

template <class Value>
std::string message_of(const Expected<Value>& outcome) {
  if (outcome) return "no error";
  EXPECT_EQ(outcome.error().kind, ErrorKind::device);
  return outcome.error().message;
}

constexpr const char* silent =
    "camera D5000 at usb:001,004: does not answer: switch it off and on, check the cable";
constexpr const char* nonsense =
    "camera D5000 at usb:001,004: its driver answered nonsense: switch it off and on, check the cable";
constexpr const char* crashed =
    "camera D5000 at usb:001,004: its driver stopped (signal 11): switch it off and on, check the cable";

TEST(Gphoto2Camera, PhotographsAndCloses) {
  const std::size_t before = open_descriptors();
  Gphoto2Camera camera(with({}));
  const auto identity = camera.open();
  ASSERT_TRUE(identity) << identity.error().message;
  EXPECT_EQ(identity->model, "D5000");
  EXPECT_EQ(identity->serial, "1234567");
  const CameraSettings wanted{66'667, 400, 5.6, {2144, 1424}};
  const auto settings = camera.configure(wanted);
  ASSERT_TRUE(settings) << settings.error().message;
  EXPECT_EQ(*settings, wanted);
  for (int shot = 0; shot < 3; ++shot) {
    ASSERT_EQ(message_of(camera.expose()), "no error");
    const auto picture = camera.fetch();
    ASSERT_TRUE(picture) << picture.error().message;
    EXPECT_EQ(picture->file.size(), 15U);
    EXPECT_EQ(picture->file.front(), std::byte{0xff});
    EXPECT_EQ(picture->exposure_end_us, 123'456);
  }
  EXPECT_TRUE(camera.preview());
  camera.close();
  camera.close();
  EXPECT_EQ(open_descriptors(), before);
  EXPECT_EQ(child_processes(), 0U);
  EXPECT_TRUE(camera.open());
}

TEST(Gphoto2Camera, CallsInTheWrongStateNameBothStates) {
  Gphoto2Camera camera(with({}));
  EXPECT_EQ(message_of(camera.expose()), "camera at usb:001,004: expose needs it ready, it is closed");
  EXPECT_EQ(message_of(camera.configure({})),
            "camera at usb:001,004: configure needs it ready, it is closed");
  EXPECT_EQ(message_of(camera.preview()), "camera at usb:001,004: preview needs it ready, it is closed");
  ASSERT_TRUE(camera.open());
  EXPECT_EQ(message_of(camera.open()), "camera D5000 at usb:001,004: open needs it closed, it is ready");
  EXPECT_EQ(message_of(camera.fetch()), "camera D5000 at usb:001,004: fetch needs it exposed, it is ready");
  ASSERT_TRUE(camera.configure({}));
  ASSERT_TRUE(camera.expose());
  EXPECT_EQ(message_of(camera.expose()), "camera D5000 at usb:001,004: expose needs it ready, it is exposed");
  EXPECT_EQ(message_of(camera.configure({})),
            "camera D5000 at usb:001,004: configure needs it ready, it is exposed");
  EXPECT_TRUE(camera.fetch());
}

TEST(Gphoto2Camera, ARefusalLeavesTheCameraReady) {
  Gphoto2Camera camera(with({"configure=refuse"}));
  ASSERT_TRUE(camera.open());
  EXPECT_EQ(message_of(camera.configure({})),
            "camera D5000 at usb:001,004: the mode dial is not on M: turn it to M");
  EXPECT_TRUE(camera.preview());
}

struct Trouble {
  const char* behaviour;
  const char* message;
};

// Makes the call that the behaviour names fail.
std::string message_of_call(Gphoto2Camera& camera, std::string_view call) {
  if (call.starts_with("configure")) return message_of(camera.configure({}));
  if (call.starts_with("preview")) return message_of(camera.preview());
  const auto configured = camera.configure({1'000, 200, 8, {}});
  if (!configured) return configured.error().message;
  auto exposed = camera.expose();
  if (call.starts_with("expose") || !exposed) return message_of(exposed);
  return message_of(camera.fetch());
}

TEST(Gphoto2Camera, TroubleLosesTheCameraInTimeAndItOpensAgain) {
  const std::vector<Trouble> troubles = {
      {"configure=hang", silent},
      {"configure=die", crashed},
      {"configure=garbage", nonsense},
      {"expose=hang", silent},
      {"expose=die", crashed},
      {"expose=leave",
       "camera D5000 at usb:001,004: its driver stopped (exit status 7): switch it off and on, check the "
       "cable"},
      {"expose=lost",
       "camera D5000 at usb:001,004: reading: I/O problem: switch it off and on, check the cable"},
      {"expose=garbage", nonsense},
      {"expose=oversized", nonsense},
      {"expose=stale-number", nonsense},
      {"expose=wrong-reply", nonsense},
      {"expose=attached", nonsense},
      {"expose=progress", nonsense},
      {"expose=empty",
       "camera D5000 at usb:001,004: its driver stopped: switch it off and on, check the cable"},
      {"fetch=hang", silent},
      {"fetch=die", crashed},
      {"fetch=no-memory", nonsense},
      {"fetch=unsealed", nonsense},
      {"fetch=wrong-size", nonsense},
      {"fetch=too-large", nonsense},
      {"fetch=socket", nonsense},
      {"fetch=two-descriptors", nonsense},
      {"fetch=stale-number", nonsense},
      {"fetch=progress", silent},
      {"fetch=endless", silent},
      {"preview=hang", silent},
      {"preview=unsealed", nonsense},
  };
  const std::size_t before = open_descriptors();
  for (const Trouble& trouble : troubles) {
    Gphoto2Camera camera(with({trouble.behaviour}));
    ASSERT_TRUE(camera.open()) << trouble.behaviour;
    const auto start = steady_clock::now();
    EXPECT_EQ(message_of_call(camera, trouble.behaviour), trouble.message) << trouble.behaviour;
    EXPECT_LT(steady_clock::now() - start, milliseconds(1'800)) << trouble.behaviour;
    EXPECT_EQ(camera.worker_pid(), -1) << trouble.behaviour;
    EXPECT_EQ(child_processes(), 0U) << trouble.behaviour;
    EXPECT_EQ(open_descriptors(), before) << trouble.behaviour;
    EXPECT_EQ(message_of(camera.expose()),
              "camera D5000 at usb:001,004: expose needs it ready, it is lost: open it again");
    EXPECT_TRUE(camera.open()) << trouble.behaviour;
    EXPECT_TRUE(std::string_view(trouble.behaviour).starts_with("preview") || camera.preview());
  }
}

TEST(Gphoto2Camera, ThePatienceOfAShotIsItsExposureAndSomeMore) {
  Gphoto2Camera camera(with({"expose=hang"}));
  ASSERT_TRUE(camera.open());
  ASSERT_TRUE(camera.configure({500'000, 200, 8, {}}));
  const auto start = steady_clock::now();
  EXPECT_EQ(message_of(camera.expose()), silent);
  EXPECT_GE(steady_clock::now() - start, milliseconds(850));
  EXPECT_LT(steady_clock::now() - start, milliseconds(1'800));
}

TEST(Gphoto2Camera, APictureThatKeepsComingHasTime) {
  Gphoto2Camera camera(with({"fetch=steady"}));
  ASSERT_TRUE(camera.open());
  ASSERT_TRUE(camera.expose());
  const auto start = steady_clock::now();
  EXPECT_EQ(message_of(camera.fetch()), "no error");
  EXPECT_GT(steady_clock::now() - start, short_deadlines.fetch);
}

TEST(Gphoto2Camera, TroubleWhileOpening) {
  Gphoto2Camera refusing(with({"open=refuse"}));
  EXPECT_EQ(message_of(refusing.open()), "camera at usb:001,004: the mode dial is not on M: turn it to M");
  EXPECT_EQ(message_of(refusing.expose()), "camera at usb:001,004: expose needs it ready, it is closed");
  Gphoto2Options hanging = with({"open=hang"});
  hanging.deadlines.open = milliseconds(300);
  Gphoto2Camera silent_camera(hanging);
  EXPECT_EQ(message_of(silent_camera.open()),
            "camera at usb:001,004: does not answer: switch it off and on, check the cable");
  Gphoto2Options missing = with({});
  missing.worker.executable = "/nowhere";
  EXPECT_EQ(message_of(Gphoto2Camera(missing).open()),
            "camera at usb:001,004: the camera worker cannot be started: No such file or directory");
  EXPECT_EQ(child_processes(), 0U);
}

TEST(Gphoto2Camera, AWorkerThatWillNotLeaveIsKilled) {
  Gphoto2Camera camera(with({"close=hang"}));
  ASSERT_TRUE(camera.open());
  const auto start = steady_clock::now();
  camera.close();
  EXPECT_LT(steady_clock::now() - start, milliseconds(1'500));
  EXPECT_EQ(child_processes(), 0U);
}

TEST(Gphoto2Camera, TheWorkerInheritsNothingOfOurs) {
  const UniqueFd leaky(::dup(STDERR_FILENO));  // not close-on-exec
  struct sigaction ignore = {};
  struct sigaction earlier = {};
  ignore.sa_handler = SIG_IGN;
  ::sigaction(SIGPIPE, &ignore, &earlier);
  sigset_t interrupts;
  sigemptyset(&interrupts);
  sigaddset(&interrupts, SIGINT);
  ::pthread_sigmask(SIG_BLOCK, &interrupts, nullptr);
  for (const char* home : {"", "/var/tmp"}) {
    Gphoto2Options options = with({"open=surroundings"});
    options.worker.home = home;
    Gphoto2Camera camera(options);
    const auto identity = camera.open();
    ASSERT_TRUE(identity) << identity.error().message;
    EXPECT_EQ(identity->problems, std::vector<std::string>());
    EXPECT_EQ(identity->model, *home == '\0' ? "/dev/null" : home);
    EXPECT_EQ(identity->serial, "C");
  }
  ::pthread_sigmask(SIG_UNBLOCK, &interrupts, nullptr);
  ::sigaction(SIGPIPE, &earlier, nullptr);
}

TEST(Gphoto2Camera, KilledAtRandomMomentsItIsLostAndOpensAgain) {
  const std::size_t before = open_descriptors();
  std::mt19937 random(7);
  int lost = 0;
  for (int cycle = 0; cycle < 50; ++cycle) {
    Gphoto2Camera camera(with({"expose=slow", "fetch=slow"}));
    ASSERT_TRUE(camera.open());
    std::thread killer([pid = camera.worker_pid(), delay = milliseconds(random() % 300)] {
      std::this_thread::sleep_for(delay);
      ::kill(pid, SIGKILL);
    });
    auto exposed = camera.expose();
    const bool alive = exposed && camera.fetch();
    killer.join();
    if (alive) continue;
    ++lost;
    EXPECT_EQ(camera.worker_pid(), -1);
    EXPECT_TRUE(camera.open());
  }
  EXPECT_GT(lost, 20);
  EXPECT_EQ(child_processes(), 0U);
  EXPECT_EQ(open_descriptors(), before);
}

TEST(Gphoto2Camera, FiftyTimesOpenAndClosedLeavesNothingBehind) {
  const std::size_t before = open_descriptors();
  Gphoto2Camera camera(with({}));
  for (int cycle = 0; cycle < 50; ++cycle) {
    ASSERT_TRUE(camera.open());
    ASSERT_TRUE(camera.expose());
    ASSERT_TRUE(camera.fetch());
    camera.close();
  }
  EXPECT_EQ(child_processes(), 0U);
  EXPECT_EQ(open_descriptors(), before);
}

TEST(ListCameras, TellsModelAndPort) {
  const auto cameras = list_cameras(with({}).worker);
  ASSERT_TRUE(cameras) << cameras.error().message;
  ASSERT_EQ(cameras->size(), 1U);
  EXPECT_EQ(cameras->front().model, "Nikon DSC D5000 (PTP mode)");
  EXPECT_EQ(cameras->front().port, "usb:001,004");
}

TEST(ListCameras, TroubleIsAnError) {
  for (const char* behaviour :
       {"list=hang", "list=die", "list=garbage", "list=refuse", "list=stale-number"}) {
    const auto cameras = list_cameras(with({behaviour}).worker, milliseconds(300));
    EXPECT_TRUE(message_of(cameras).starts_with("cameras cannot be listed: ")) << behaviour;
  }
  EXPECT_EQ(child_processes(), 0U);
}

}  // namespace
}  // namespace bodyscan::gphoto2
