// Calibrations that the executable finds in simulated sessions, and in the real pictures of a printed board
// when they are there (BODYSCAN_SHARED, else ../shared beside the source tree).
#include "pipeline/calibration/calibration_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/bench/child_process.hpp"
#include "tools/simulator/session_folder.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using simulator::Blunder;
using simulator::SessionMethod;

simulator::SessionOptions session(SessionMethod method, double scale, const fs::path& folder) {
  simulator::SessionOptions options;
  options.render.calibration = "builtin:diagonal";
  options.render.rig.name = "diagonal";
  options.render.rig.scale = scale;
  options.render.output = folder;
  options.method = method;
  return options;
}

struct Calibrated {
  int status = 0;
  json report;
  Calibration calibration;
};

Calibrated calibrate(const fs::path& session, const fs::path& work, std::vector<std::string> more = {}) {
  const fs::path output = work / "calibration.yml";
  std::vector<std::string> command{BODYSCAN_EXECUTABLE, "calibrate",     session.string(),
                                   "--output",          output.string(), "--json"};
  command.insert(command.end(), more.begin(), more.end());
  const fs::path report = work / "report.json";
  Calibrated result;
  result.status = run_program(command, report).value().exit_status;
  if (result.status != 0) return result;
  std::ifstream stream(report);
  result.report = json::parse(stream);
  result.calibration = read_calibration(output).value();
  return result;
}

double figure(const Calibrated& result, const char* key) {
  return result.report.at(key).get<double>();
}

void expect_near(const Calibration& found, const Calibration& truth, double relative) {
  EXPECT_NEAR(found.camera.fx / truth.camera.fx, 1, relative);
  EXPECT_NEAR(found.projector.fx / truth.projector.fx, 1, relative);
  EXPECT_NEAR(found.projector_from_camera.translation.norm() / truth.projector_from_camera.translation.norm(),
              1, relative);
}

TEST(SimulatedSession, OfPairsGivesTheRig) {
  const TemporaryFolder folder;
  const auto truth =
      simulator::render_session(session(SessionMethod::projected, 0.5, folder.path() / "session"));
  ASSERT_TRUE(truth) << truth.error().message;
  const Calibrated found = calibrate(folder.path() / "session", folder.path());
  ASSERT_EQ(found.status, 0);
  expect_near(found.calibration, truth->calibration, 3e-4);
  EXPECT_LE(figure(found, "camera_rms_px"), 0.08);
  EXPECT_LE(figure(found, "projector_rms_px"), 0.06);

  // The projector is moved: one pair and the lenses of before tell where it stands.
  const fs::path one = folder.path() / "one";
  fs::create_directories(one);
  std::ifstream whole(folder.path() / "session" / "session.json");
  json manifest = json::parse(whole);
  manifest["poses"] = json::array({manifest["poses"][2]});
  for (const auto& [key, file] : manifest["poses"][0].items())
    fs::create_symlink(folder.path() / "session" / file.get<std::string>(), one / file.get<std::string>());
  std::ofstream(one / "session.json") << manifest;
  Calibration elsewhere = truth->calibration;
  elsewhere.projector_from_camera.translation += Eigen::Vector3d(30, -20, 15);
  ASSERT_TRUE(write_calibration(elsewhere, folder.path() / "elsewhere.yml"));
  const Calibrated again =
      calibrate(one, folder.path(), {"--keep-intrinsics", (folder.path() / "elsewhere.yml").string()});
  ASSERT_EQ(again.status, 0);
  EXPECT_LT((again.calibration.projector_from_camera.translation -
             truth->calibration.projector_from_camera.translation)
                .norm(),
            0.5);
  EXPECT_EQ(again.calibration.camera.fx, truth->calibration.camera.fx);
}

TEST(SimulatedSession, OfGrayCodeGivesTheRig) {
  const TemporaryFolder folder;
  auto options = session(SessionMethod::gray, 0.5, folder.path() / "session");
  options.poses = 4;
  options.render.rays = 1;
  const auto truth = simulator::render_session(options);
  ASSERT_TRUE(truth) << truth.error().message;
  const Calibrated found = calibrate(folder.path() / "session", folder.path());
  ASSERT_EQ(found.status, 0);
  expect_near(found.calibration, truth->calibration, 1e-3);
  EXPECT_LE(figure(found, "camera_rms_px"), 0.08);
  EXPECT_LE(figure(found, "projector_rms_px"), 0.05);
  EXPECT_LE(std::abs(figure(found, "square_error_percent")), 0.02);
}

struct Planted {
  Blunder kind;
  const char* reason;
};

// Each alone in a session of small pictures; the poses before and after it are sound.
TEST(SimulatedSession, NamesTheBadPoseAndGoesOnWithoutIt) {
  const TemporaryFolder folder;
  const auto clean =
      simulator::render_session(session(SessionMethod::projected, 0.3, folder.path() / "clean"));
  ASSERT_TRUE(clean) << clean.error().message;
  const Calibrated reference = calibrate(folder.path() / "clean", folder.path());
  ASSERT_EQ(reference.status, 0);
  for (const Planted& planted : {Planted{Blunder::cut, "cut off"}, Planted{Blunder::moved, "moved"},
                                 Planted{Blunder::blurred, "blurred"}, Planted{Blunder::size, "8 x 7"},
                                 Planted{Blunder::scaled, "26."}, Planted{Blunder::dark, "too dark"},
                                 Planted{Blunder::overexposed, "over-exposed"}}) {
    SCOPED_TRACE(name_of(planted.kind));
    auto options = session(SessionMethod::projected, 0.3, folder.path() / name_of(planted.kind));
    options.blunders = {{3, planted.kind}};
    ASSERT_TRUE(simulator::render_session(options));
    const Calibrated found = calibrate(options.render.output, folder.path());
    ASSERT_EQ(found.status, 0);
    for (std::size_t i = 0; i < found.report.at("poses").size(); ++i) {
      const json& pose = found.report.at("poses").at(i);
      EXPECT_EQ(pose.at("used").get<bool>(), i != 3) << pose.at("name") << ": " << pose.at("reason");
    }
    const std::string reason = found.report.at("poses").at(3).at("reason");
    EXPECT_NE(reason.find(planted.reason), std::string::npos) << reason;
    EXPECT_LE(figure(found, "joint_rms_px"), 1.2 * figure(reference, "joint_rms_px"));
    expect_near(found.calibration, clean->calibration, 1e-3);
  }
}

TEST(SimulatedSession, OfTwoPosesIsTooFew) {
  const TemporaryFolder folder;
  auto options = session(SessionMethod::projected, 0.3, folder.path() / "session");
  options.poses = 3;
  options.blunders = {{1, Blunder::cut}};
  ASSERT_TRUE(simulator::render_session(options));
  EXPECT_EQ(calibrate(options.render.output, folder.path()).status, 3);
  EXPECT_FALSE(fs::exists(folder.path() / "calibration.yml"));
}

TEST(RealBoard, IsCalibratedFromThreePoses) {
  const char* shared = std::getenv("BODYSCAN_SHARED");
  const fs::path root = shared ? fs::path(shared) : fs::path(BODYSCAN_SOURCE_DIR) / ".." / "shared";
  const fs::path board = root / "data" / "procam-board";
  if (!fs::exists(board / "session.json")) {
    std::cerr << "\n*** SKIPPED: no real pictures in " << board
              << "; set BODYSCAN_SHARED to the folder that holds data/procam-board ***\n\n";
    GTEST_SKIP();
  }
  const TemporaryFolder folder;
  const Calibrated found = calibrate(board, folder.path());
  ASSERT_EQ(found.status, 0);
  std::cout << "camera " << figure(found, "camera_rms_px") << ", projector "
            << figure(found, "projector_rms_px") << ", together " << figure(found, "joint_rms_px")
            << " px; squares off by " << figure(found, "square_error_percent") << " %\n";
  for (const json& advice : found.report.at("advice")) std::cout << advice << "\n";
  EXPECT_LE(figure(found, "camera_rms_px"), 0.20);
  EXPECT_LE(figure(found, "projector_rms_px"), 0.12);
  EXPECT_LE(figure(found, "joint_rms_px"), 0.17);
  EXPECT_LE(std::abs(figure(found, "square_error_percent")), 0.05);
}

}  // namespace
}  // namespace bodyscan
