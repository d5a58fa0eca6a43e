// The real pictures of a printed board, when they are there: BODYSCAN_SHARED names the folder that holds
// data/procam-board; without it ../shared beside the source tree is looked at.
#include "pipeline/calibration/calibration_file.hpp"
#include "pipeline/model/vrml_reader.hpp"
#include "tests/accuracy/board.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/bench/child_process.hpp"
#include "tools/bench/link_capture.hpp"

#include <cstdlib>
#include <fstream>
#include <iostream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double square_mm = 75;

// Of a square's side. The printed sheet itself curls: cubic surfaces fitted square by square to the white
// squares have an RMS of 0.35 % about one plane, 0.47 % in pose 0, where the black squares decode too.
constexpr double max_mean_rms = 0.0042;
constexpr double max_p95 = 0.0128;

fs::path data_folder() {
  const char* shared = std::getenv("BODYSCAN_SHARED");
  const fs::path root = shared ? fs::path(shared) : fs::path(BODYSCAN_SOURCE_DIR) / ".." / "shared";
  return root / "data" / "procam-board";
}

json read_json(const fs::path& file) {
  std::ifstream stream(file);
  return json::parse(stream);
}

class RealCaptures : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    if (!fs::exists(data_folder() / "calibration_reference.yml")) {
      std::cerr << "\n*** SKIPPED: no real pictures in " << data_folder()
                << "; set BODYSCAN_SHARED to the folder that holds data/procam-board ***\n\n";
      GTEST_SKIP();
    }
  }

  [[nodiscard]] static std::string white_frame(const fs::path& capture) {
    const json manifest = read_json(capture / "capture.json");
    for (const json& frame : manifest.at("frames")) {
      if (frame.at("pattern") == "white") return frame.at("file");
    }
    throw std::runtime_error("no white frame");
  }

  [[nodiscard]] BoardFigures measure_pose(const fs::path& pose, bool rows_only) const {
    const fs::path reference = data_folder() / "calibration_reference.yml";
    const fs::path capture = work_ / pose.filename();
    if (const Expected<void> linked = link_capture(pose, capture, rows_only); !linked) {
      throw std::runtime_error(linked.error().message);
    }
    const fs::path model = work_ / "model.wrl";
    const ProcessUsage run = run_program({BODYSCAN_EXECUTABLE, "reconstruct", capture.string(),
                                          "--calibration", reference.string(), "--output", model.string()})
                                 .value();
    if (run.exit_status != 0)
      throw std::runtime_error("reconstruct ended with " + std::to_string(run.exit_status));
    const Lens camera = read_calibration(reference).value().camera;
    const Board board = Board::find(capture / white_frame(capture), camera);
    return measure_board(board, camera, read_model(model).value().mesh, square_mm);
  }

 private:
  const TemporaryFolder work_;
};

TEST_P(RealCaptures, OfAPrintedBoardGiveAPlane) {
  const bool rows_only = GetParam();
  double mean_rms = 0;
  for (const char* pose : {"pose_0", "pose_1", "pose_2"}) {
    const BoardFigures figures = measure_pose(data_folder() / pose, rows_only);
    std::cout << pose << (rows_only ? ", rows" : ", rows and columns") << ": plane RMS "
              << 100 * figures.plane_rms << " %, p95 " << 100 * figures.p95 << " % of a square's side, "
              << 100 * figures.white_covered << " % of the white squares, " << figures.points << " points\n";
    mean_rms += figures.plane_rms / 3;
    EXPECT_LE(figures.p95, max_p95) << pose;
    EXPECT_GE(figures.white_covered, 0.95) << pose;
  }
  std::cout << "mean plane RMS " << 100 * mean_rms << " %\n";
  EXPECT_LE(mean_rms, max_mean_rms);
}

INSTANTIATE_TEST_SUITE_P(Axes, RealCaptures, testing::Bool(), [](const auto& instance) {
  return instance.param ? std::string("rows") : std::string("rows_and_columns");
});

}  // namespace
}  // namespace bodyscan
