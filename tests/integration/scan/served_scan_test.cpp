// The scan command and a served world: libgphoto2, the camera's worker and the virtual projector are real.
#include "reference.hpp"
#include "station.hpp"
#include "tests/support/test_files.hpp"

#include <chrono>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <random>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

namespace bodyscan {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

const std::vector<std::string> all_files{"model.wrl", "report.json"};

TEST(Scan, IsAsGoodAsReconstructTwiceInARow) {
  Station station;
  for (int i = 0; i < 2; ++i) {
    const ScanEnd end = station.scan();
    ASSERT_EQ(end.status, 0) << end.error;
    EXPECT_EQ(end.error, "");
    EXPECT_EQ(station.files(), all_files);
    reference().expect_as_good(station.model());
    const nlohmann::json report = station.report();
    EXPECT_EQ(report.at("camera").at("model"), "D5000");
    EXPECT_EQ(report.at("exposure_us"), 12'500);
    EXPECT_EQ(report.at("iso"), 800);
    EXPECT_EQ(report.at("shots"), 19);  // white, black, eight bits and their inverses, white
    EXPECT_TRUE(report.at("refused").empty());
    EXPECT_TRUE(report.at("troubles").empty());
    EXPECT_EQ(report.at("shot_again_for_motion"), 0);
    EXPECT_LT(report.at("motion_mm").get<double>(), 0.5);
    EXPECT_LT(report.at("after_last_shot_ms").get<double>(), 1000);
    EXPECT_LT(report.at("light_s").get<double>(), end.seconds);
  }
}

// The served projector's two pictures, as they are in the memory that it shares with the scan.
class ShownPictures {
 public:
  explicit ShownPictures(pid_t server) {
    const std::string folder = "/proc/" + std::to_string(server) + "/fd";
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      std::error_code gone;
      const std::string target = std::filesystem::read_symlink(entry.path(), gone);
      if (target.find("memfd:projector pictures") == std::string::npos) continue;
      const int memory = open(entry.path().c_str(), O_RDONLY | O_CLOEXEC);
      void* mapped = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, memory, 0);
      close(memory);
      if (mapped != MAP_FAILED) pictures_ = static_cast<const volatile unsigned char*>(mapped);
    }
    EXPECT_NE(pictures_, nullptr);
  }
  ShownPictures(const ShownPictures&) = delete;
  ShownPictures& operator=(const ShownPictures&) = delete;
  ~ShownPictures() {
    if (pictures_ != nullptr) munmap(const_cast<unsigned char*>(pictures_), bytes);
  }

  [[nodiscard]] int black() const {
    if (pictures_ == nullptr) return 0;
    int count = 0;
    for (const volatile unsigned char* picture : {pictures_, pictures_ + bytes / 2}) {
      std::size_t lit = 0;
      for (std::size_t i = 0; i < bytes / 2; ++i) lit += picture[i] != 0 ? 1U : 0U;
      count += lit == 0 ? 1 : 0;
    }
    return count;
  }

 private:
  static constexpr std::size_t bytes = std::size_t{2} * 256 * 192;
  const volatile unsigned char* pictures_ = nullptr;
};

TEST(Scan, AnInterruptDarkensTheProjectorAndEndsItBySignal) {
  Station station;
  RunningScan scan = station.start();
  std::this_thread::sleep_for(milliseconds(1700));
  {
    const ShownPictures shown(station.world().pid());
    ASSERT_EQ(shown.black(), 0) << "not in the middle of the patterns";
    const auto interrupted = steady_clock::now();
    kill(scan.pid(), SIGINT);
    while (shown.black() == 0 && steady_clock::now() < interrupted + std::chrono::seconds(1)) {
    }
    // 10 ms until it is noticed, and the flip that may be under way.
    EXPECT_LT(steady_clock::now() - interrupted, milliseconds(150));
    const ScanEnd end = scan.end(std::chrono::seconds(10));
    EXPECT_EQ(end.status, -SIGINT);
    EXPECT_EQ(end.error, "bodyscan: interrupted\n");
    EXPECT_LT(steady_clock::now() - interrupted, std::chrono::seconds(3));
    EXPECT_EQ(shown.black(), 2);
  }
  EXPECT_TRUE(station.files().empty());
  const ScanEnd next = station.scan();
  ASSERT_EQ(next.status, 0) << next.error;
  reference().expect_as_good(station.model());
}

TEST(Scan, AWorldThatEndsEndsTheScan) {
  Station station;
  RunningScan scan = station.start();
  std::this_thread::sleep_for(milliseconds(1700));
  station.world().end(SIGKILL);
  const ScanEnd end = scan.end(std::chrono::seconds(30));
  EXPECT_EQ(end.status, 4);
  EXPECT_TRUE(end.error.starts_with("bodyscan: camera D5000 at ptpip:") ||
              end.error.starts_with("bodyscan: projector at "))
      << end.error;
  EXPECT_TRUE(station.files().empty());
}

TEST(Scan, EveryProblemOfTheRigFileIsNamed) {
  const TemporaryFolder folder;
  const std::filesystem::path rig = folder / "rig.toml";
  write_text(rig,
             "colour = 1\n[camera]\nbackend = \"box\"\niso = 7\nexposure_us = \"long\"\n"
             "[projector]\nbackend = \"virtual\"\n[scan]\nattempts = 0\n");
  const ScanEnd end =
      RunningScan({BODYSCAN_EXECUTABLE, "scan", "--rig", rig, "--output", folder / "model.wrl"},
                  folder / "error")
          .end(std::chrono::seconds(10));
  EXPECT_EQ(end.status, 3);
  for (const char* wanted : {"calibration: is missing", "colour: is not known",
                             "camera.backend: ", "camera.iso: 7 is not between 50 and 102400",
                             "camera.exposure_us: must be a whole number", "projector.socket: is missing",
                             "scan.attempts: 0 is not between 1 and 20"})
    EXPECT_NE(end.error.find(rig.string() + ": " + wanted), std::string::npos) << end.error;
  EXPECT_FALSE(std::filesystem::exists(folder / "model.wrl"));
}

// Scans until so many workers were killed; how many of the scans made a model.
int scan_while_killing(int kills, unsigned seed) {
  Station station;
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> moment_ms(0, 1500);
  int models = 0;
  for (int killed = 0; killed < kills;) {
    RunningScan scan = station.start();
    while (scan.running() && killed < kills) {
      std::this_thread::sleep_for(milliseconds(moment_ms(random)));
      const auto worker = scan.running() ? scan.worker() : std::nullopt;
      if (!worker) continue;
      kill(*worker, SIGKILL);
      ++killed;
    }
    const ScanEnd end = scan.end(std::chrono::seconds(40));
    if (end.status == 0) {
      ++models;
      reference().expect_as_good(station.model());
    } else {
      EXPECT_EQ(end.status, 4) << end.error;
      EXPECT_TRUE(end.error.starts_with("bodyscan: camera ")) << end.error;
      EXPECT_TRUE(station.files().empty());
    }
  }
  const ScanEnd next = station.scan();
  EXPECT_EQ(next.status, 0) << next.error;
  return models;
}

TEST(Scan, AKilledCameraWorkerCostsShotsOrTheScanButNeverTheModel) {
  static_cast<void>(reference());
  int models = 0;
  std::thread beside([&] { models = scan_while_killing(10, 1); });
  EXPECT_GT(scan_while_killing(10, 2), 0);
  beside.join();
  EXPECT_GT(models, 0);
}

}  // namespace
}  // namespace bodyscan
