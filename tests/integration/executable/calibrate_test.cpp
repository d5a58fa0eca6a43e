#include "pipeline/calibration/calibration_file.hpp"
#include "process.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_files.hpp"
#include "tools/simulator/session_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Three pairs and, last, a Gray-code capture, rendered once; every test has a copy to damage.
class CalibrateExecutable : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    rendered_ = new TemporaryFolder;
    simulator::SessionOptions options;
    options.render.calibration = "builtin:diagonal";
    options.render.rig.name = "diagonal";
    options.render.rig.scale = 0.2;
    options.render.rays = 1;
    options.render.output = *rendered_ / "session";
    options.poses = 4;
    const auto truth = simulator::render_session(options);
    ASSERT_TRUE(truth) << truth.error().message;
  }
  static void TearDownTestSuite() {
    delete rendered_;
    rendered_ = nullptr;
  }
  void SetUp() override {
    fs::create_directory(folder_ / "results");
    fs::copy(*rendered_ / "session", session_, fs::copy_options::recursive);
  }

  [[nodiscard]] ProcessResult calibrate(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"calibrate", session_, "--output", result("calibration.yml")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_bodyscan(arguments);
  }
  [[nodiscard]] std::string result(const char* name) const { return folder_ / "results" / name; }
  [[nodiscard]] std::vector<std::string> results() const {
    std::vector<std::string> names;
    for (const auto& [name, text] : snapshot(folder_ / "results")) names.push_back(name);
    return names;
  }
  // What standard error says of a session that cannot be calibrated; nothing may be written.
  void expect_refused(const std::vector<std::string>& message,
                      const std::vector<std::string>& more = {}) const {
    write_text(result("calibration.yml"), "the calibration of last time");
    const auto before = snapshot(folder_.path());
    std::vector<std::string> options{"--report", result("report.json"), "--plots", result("plots")};
    options.insert(options.end(), more.begin(), more.end());
    const ProcessResult run = calibrate(options);
    EXPECT_EQ(run.status, 3) << run.error;
    EXPECT_EQ(run.output, "");
    EXPECT_TRUE(run.error.starts_with("bodyscan: ")) << run.error;
    for (const std::string& part : message)
      EXPECT_NE(run.error.find(part), std::string::npos) << "no \"" << part << "\" in: " << run.error;
    EXPECT_TRUE(snapshot(folder_.path()) == before);
  }

  TemporaryFolder folder_;
  const fs::path session_ = folder_ / "session";

 private:
  inline static TemporaryFolder* rendered_ = nullptr;
};

TEST_F(CalibrateExecutable, WritesCalibrationReportAndPlots) {
  const ProcessResult run =
      calibrate({"--report", result("report.json"), "--plots", result("plots"), "--json"});
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(results(),
            (std::vector<std::string>{"calibration.yml", "plots", "plots/coverage.svg", "plots/histogram.svg",
                                      "plots/poses.svg", "plots/residuals.svg", "report.json"}));
  const auto truth = read_calibration(session_ / "calibration.yml");
  const auto found = read_calibration(result("calibration.yml"));
  ASSERT_TRUE(truth && found);
  EXPECT_NEAR(found->camera.fx / truth->camera.fx, 1, 0.003);
  EXPECT_NEAR(found->projector.fx / truth->projector.fx, 1, 0.003);
  EXPECT_EQ(read_text(result("report.json")), run.output);
  const json report = json::parse(run.output);
  EXPECT_LT(report.at("joint_rms_px"), 0.1);
  EXPECT_EQ(report.at("poses").size(), 4);
  for (const json& pose : report.at("poses")) EXPECT_TRUE(pose.at("used")) << pose.at("reason");
}

TEST_F(CalibrateExecutable, TellsPeopleTheFiguresAndNamesTheBadPose) {
  fs::copy_file(session_ / "pose_0_printed.jpg", session_ / "pose_2_projected.jpg",
                fs::copy_options::overwrite_existing);
  const ProcessResult run = calibrate();
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_NE(run.output.find("calibration.yml: camera 0.0"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("pose 2 left out: "), std::string::npos) << run.output;
}

TEST_F(CalibrateExecutable, FindsTheProjectorAgainFromOnePose) {
  json manifest = json::parse(read_text(session_ / "session.json"));
  manifest["poses"] = json::array({manifest["poses"][0]});
  write_text(session_ / "session.json", manifest.dump());
  expect_refused({"session: at least 3 good poses", "1 is there"});
  const ProcessResult run = calibrate({"--keep-intrinsics", session_ / "calibration.yml"});
  ASSERT_EQ(run.status, 0) << run.error;
  const auto truth = read_calibration(session_ / "calibration.yml");
  const auto found = read_calibration(result("calibration.yml"));
  ASSERT_TRUE(truth && found);
  EXPECT_EQ(found->camera.fx, truth->camera.fx);
  EXPECT_LT((found->projector_from_camera.translation - truth->projector_from_camera.translation).norm(), 1);
}

TEST_F(CalibrateExecutable, KeepsIntrinsicsOnlyOfTheSameDevices) {
  replace_in(session_ / "calibration.yml", "projector_size: [ 1024, 768 ]", "projector_size: [ 800, 600 ]");
  expect_refused({"calibration.yml", "projector", "800 x 600", "1024 x 768"},
                 {"--keep-intrinsics", session_ / "calibration.yml"});
  expect_refused({"absent.yml", "No such file"}, {"--keep-intrinsics", folder_ / "absent.yml"});
}

TEST_F(CalibrateExecutable, NamesTheResultThatCannotBeWritten) {
  write_text(result("plots"), "no folder");
  expect_refused({"plots"});
  fs::remove(result("plots"));
  const ProcessResult run = calibrate({"--report", folder_ / "absent" / "report.json"});
  EXPECT_EQ(run.status, 3);
  EXPECT_NE(run.error.find("absent/report.json"), std::string::npos) << run.error;
  EXPECT_EQ(results(), std::vector<std::string>{"calibration.yml"});
}

TEST_F(CalibrateExecutable, OverwritesNoPicture) {
  const fs::path picture = session_ / "pose_2_printed.jpg";
  const std::string before = read_text(picture);
  const ProcessResult run = calibrate({"--report", picture});
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.error.find("pose_2_printed.jpg: is an input"), std::string::npos) << run.error;
  EXPECT_TRUE(read_text(picture) == before);
}

TEST_F(CalibrateExecutable, KeepsEveryPlotApartFromTheOtherResults) {
  for (const char* plot : {"residuals.svg", "coverage.svg", "poses.svg", "histogram.svg"}) {
    const ProcessResult run =
        calibrate({"--plots", result("plots"), "--report", fs::path(result("plots")) / plot});
    EXPECT_EQ(run.status, 2) << plot;
    EXPECT_NE(run.error.find(std::string(plot) + ": named for two results"), std::string::npos) << run.error;
  }
  EXPECT_TRUE(results().empty());
}

TEST_F(CalibrateExecutable, NamesAPlotsFolderThatCannotBeMadeBeforeAPictureIsLookedAt) {
  write_text(result("file"), "no folder");
  fs::resize_file(session_ / "pose_0_printed.jpg", 5000);
  const ProcessResult run = calibrate({"--plots", fs::path(result("file")) / "plots"});
  EXPECT_EQ(run.status, 3);
  EXPECT_NE(run.error.find("file/plots: "), std::string::npos) << run.error;
  EXPECT_EQ(results(), std::vector<std::string>{"file"});
}

struct BadSession {
  std::string name;
  std::function<void(const fs::path&)> damage;  // of a sound session folder
  std::vector<std::string> message;             // what standard error must hold, file and reason
};

void PrintTo(const BadSession& session, std::ostream* stream) {
  *stream << session.name;
}

const std::vector<BadSession> bad_sessions = {
    {"no_folder", [](const fs::path& session) { fs::remove_all(session); }, {"session.json", "No such file"}},
    {"no_manifest", [](const fs::path& session) { fs::remove(session / "session.json"); }, {"session.json"}},
    {"manifest_is_no_json",
     [](const fs::path& session) { write_text(session / "session.json", "{\"format\": "); },
     {"session.json"}},
    {"a_capture_instead",
     [](const fs::path& session) {
       replace_in(session / "session.json", "bodyscan-calibration-session", "bodyscan-capture");
     },
     {"session.json", "format"}},
    {"one_corner",
     [](const fs::path& session) { replace_in(session / "session.json", "9", "1"); },
     {"session.json", "columns"}},
    {"picture_missing",
     [](const fs::path& session) { fs::remove(session / "pose_2_projected.jpg"); },
     {"pose_2_projected.jpg", "No such file"}},
    {"picture_cut_short",
     [](const fs::path& session) { fs::resize_file(session / "pose_0_printed.jpg", 5000); },
     {"pose_0_printed.jpg"}},
    {"text_as_picture",
     [](const fs::path& session) { write_text(session / "pose_0_printed.jpg", "this is no photograph\n"); },
     {"pose_0_printed.jpg"}},
    {"picture_leaves_the_folder",
     [](const fs::path& session) {
       replace_in(session / "session.json", "pose_0_printed.jpg", "../session/pose_0_printed.jpg");
     },
     {"session.json", "poses[0].printed"}},
    {"capture_missing",
     [](const fs::path& session) { fs::remove_all(session / "pose_3"); },
     {"pose_3/capture.json", "No such file"}},
    {"frame_missing",
     [](const fs::path& session) { fs::remove(session / "pose_3" / "frame_05.jpg"); },
     {"pose_3/frame_05.jpg", "No such file"}},
    {"no_projected_board",
     [](const fs::path& session) { replace_in(session / "session.json", "projected_board", "board_2"); },
     {"session.json", "projected_board"}},
};

class BadSessions : public CalibrateExecutable, public testing::WithParamInterface<BadSession> {};

TEST_P(BadSessions, AreNamedWithExitStatus3AndNothingIsWritten) {
  GetParam().damage(session_);
  expect_refused(GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(Table, BadSessions, testing::ValuesIn(bad_sessions),
                         [](const auto& input) { return input.param.name; });

TEST(BoardExecutable, WritesBothFormats) {
  const TemporaryFolder folder;
  for (const char* name : {"board.pdf", "board.svg"}) {
    const ProcessResult run = run_bodyscan(
        {"board", "--columns", "9", "--rows", "7", "--square-mm", "25", "--output", folder / name});
    EXPECT_EQ(run.status, 0) << run.error;
    EXPECT_NE(run.output.find("297 x 210 mm"), std::string::npos) << run.output;
  }
  EXPECT_TRUE(read_text(folder / "board.pdf").starts_with("%PDF-"));
  EXPECT_NE(read_text(folder / "board.svg").find("<svg"), std::string::npos);
}

}  // namespace
}  // namespace bodyscan
