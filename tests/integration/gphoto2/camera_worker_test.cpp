// The executable in its other role, where there is no camera.
#include "hal/gphoto2/gphoto2_camera.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace bodyscan::gphoto2 {
namespace {

Gphoto2Options camera_at(const std::string& port) {
  Gphoto2Options options;
  options.port = port;
  options.worker.executable = BODYSCAN_EXECUTABLE;
  return options;
}

TEST(CameraWorker, ListsTheCamerasThatAreThere) {
  const auto cameras = list_cameras(camera_at("").worker);
  ASSERT_TRUE(cameras) << cameras.error().message;
  for (const FoundCamera& camera : *cameras) EXPECT_TRUE(camera.port.starts_with("usb:")) << camera.port;
}

TEST(CameraWorker, NoCameraIsToldWithWhatToDo) {
  // Nothing listens on port 1.
  const auto refused = Gphoto2Camera(camera_at("ptpip:127.0.0.1:1:1")).open();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::device);
  EXPECT_TRUE(refused.error().message.starts_with("camera at ptpip:127.0.0.1:1:1: cannot be opened: "))
      << refused.error().message;
  EXPECT_TRUE(refused.error().message.ends_with(": switch it off and on, check the cable"))
      << refused.error().message;
  const auto missing = Gphoto2Camera(camera_at("usb:999,999")).open();
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().message, "camera at usb:999,999: no camera there: switch it on, check the cable");
}

TEST(CameraWorker, IsNotForPeople) {
  posix_spawn_file_actions_t files{};
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, 3, "/dev/null", O_RDONLY, 0);
  char name[] = "bodyscan";
  char role[] = "camera-worker";
  char* const words[] = {name, role, nullptr};
  pid_t process = -1;
  ASSERT_EQ(posix_spawn(&process, BODYSCAN_EXECUTABLE, &files, nullptr, words, environ), 0);
  posix_spawn_file_actions_destroy(&files);
  int status = 0;
  ASSERT_EQ(waitpid(process, &status, 0), process);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 2);
}

}  // namespace
}  // namespace bodyscan::gphoto2
