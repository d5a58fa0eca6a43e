#include "app/reconstruct.hpp"

#include "app/interrupt.hpp"
#include "hal/replay/capture_manifest.hpp"
#include "pipeline/calibration/calibration_file.hpp"
#include "pipeline/image/codec.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_files.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;

constexpr Size camera{32, 24};
constexpr Size projector{16, 8};

// A sequence whose photographs show the same, lit or not, whatever was projected.
void write_flat_capture(const fs::path& folder) {
  Calibration calibration;
  calibration.camera = {.size = camera, .fx = 30, .fy = 30, .cx = 15.5, .cy = 11.5, .distortion = {}};
  calibration.projector = {.size = projector, .fx = 15, .fy = 15, .cx = 7.5, .cy = 3.5, .distortion = {}};
  calibration.projector_from_camera.translation = {0, -200, 0};
  ASSERT_TRUE(write_calibration(calibration, folder / "calibration.yml"));
  CaptureManifest manifest;
  manifest.projector = projector;
  const Expected<PatternSequence> sequence = make_sequence(projector);
  ASSERT_TRUE(sequence);
  for (const Pattern& pattern : sequence->patterns) {
    const std::string name = std::to_string(manifest.frames.size()) + ".png";
    const auto level = static_cast<std::uint8_t>(pattern.kind == PatternKind::white ? 200 : 20);
    const auto file = encode_png(GrayImage8(camera, level));
    write_bytes(folder / name, *file);
    manifest.frames.push_back({name, pattern, {}});
  }
  ASSERT_TRUE(write_manifest(manifest, folder / "capture.json"));
}

class ReconstructCommand : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "results");
    write_flat_capture(folder_);
    options_.capture = folder_;
    options_.calibration = folder_ / "calibration.yml";
    options_.model.path = folder_ / "results" / "model.wrl";
    options_.model.report = folder_ / "results" / "report.json";
  }

  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
  ReconstructOptions options_;
};

TEST_F(ReconstructCommand, LitPixelsWithoutASurfaceAreAQualityError) {
  Progress progress;
  const auto report = reconstruct(options_, progress);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().kind, ErrorKind::quality) << report.error().message;
  EXPECT_NE(report.error().message.find("768 pixels are lit"), std::string::npos) << report.error().message;
  EXPECT_TRUE(fs::is_empty(folder_ / "results"));
}

TEST_F(ReconstructCommand, InterruptLeavesNothingBehind) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // the thread pool does not outlive a fork
  EXPECT_EXIT(
      {
        install_signal_handlers();
        std::raise(SIGTERM);
        Progress progress;
        const auto report = reconstruct(options_, progress);
        std::_Exit(
            !report && report.error().message == "interrupted" && fs::is_empty(folder_ / "results") ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace bodyscan
