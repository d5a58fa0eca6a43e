#include "pipeline/image/codec.hpp"
#include "pipeline/model/vrml_reader.hpp"
#include "process.hpp"
#include "synthetic_capture.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_files.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;

class Reconstruct : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(capture());
    fs::create_directory(results());
    write_small_capture(capture());
  }

  [[nodiscard]] fs::path capture() const { return folder_.path() / "capture"; }
  [[nodiscard]] fs::path results() const { return folder_.path() / "results"; }
  [[nodiscard]] fs::path model() const { return results() / "model.wrl"; }

  [[nodiscard]] std::vector<std::string> arguments(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"reconstruct", capture(), "--calibration", capture() / "calibration.yml"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  [[nodiscard]] std::set<std::string> files_in_results() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(results())) names.insert(entry.path().filename());
    return names;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Reconstruct, MakesAModelOfTheWall) {
  const ProcessResult run = run_bodyscan(arguments({"--output", model()}));
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(run.error, "");
  EXPECT_EQ(files_in_results(), (std::set<std::string>{"model.wrl"}));

  const auto read = read_model(model());
  ASSERT_TRUE(read.has_value()) << read.error().message;
  const Mesh& mesh = read->mesh;
  EXPECT_GT(mesh.points.size(), 5000U);
  EXPECT_GT(mesh.faces.size(), 10000U);
  ASSERT_EQ(mesh.colors.size(), mesh.points.size());
  double squares = 0;
  for (const Point3f& point : mesh.points) squares += (point.z - 1000.0) * (point.z - 1000.0);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(mesh.points.size())),
            20);  // a projector row is 109 mm of depth
  EXPECT_EQ(run.output, model().string() + ": " + std::to_string(mesh.points.size()) + " points, " +
                            std::to_string(mesh.faces.size()) + " faces\n");
  EXPECT_NE(read->info.software.find("bodyscan "), std::string::npos);
  EXPECT_NE(read->info.calibration.find("calibration.yml"), std::string::npos);
}

TEST_F(Reconstruct, ReportHoldsEveryFigureAndIsWhatJsonPrints) {
  const ProcessResult run =
      run_bodyscan(arguments({"--output", model(), "--report", results() / "report.json", "--json"}));
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(read_text(results() / "report.json"), run.output);
  const auto report = nlohmann::json::parse(run.output);
  const auto read = read_model(model());
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(report.at("points"), read->mesh.points.size());
  EXPECT_EQ(report.at("faces"), read->mesh.faces.size());
  EXPECT_GT(report.at("pixels_lit"), 5000);
  EXPECT_LE(report.at("pixels_decoded"), report.at("pixels_lit"));
  EXPECT_NEAR(report.at("decoded_fraction").get<double>(),
              report.at("pixels_decoded").get<double>() / report.at("pixels_lit").get<double>(), 1e-9);
  for (const auto& [reason, count] : report.at("artifacts_removed").items())
    EXPECT_TRUE(count.is_number_unsigned()) << reason;
  EXPECT_FALSE(report.at("artifacts_removed").empty());
  EXPECT_GT(report.at("mean_uncertainty_mm"), 0);
  EXPECT_LT(report.at("mean_uncertainty_mm"), 20);
  EXPECT_GE(report.at("timings_ms").size(), 4U);
  for (const auto& [stage, milliseconds] : report.at("timings_ms").items())
    EXPECT_GE(milliseconds.get<double>(), 0) << stage;
  EXPECT_GT(report.at("peak_memory_bytes"), 1 << 20);
  EXPECT_EQ(report.at("software"), read->info.software);
  EXPECT_EQ(report.at("calibration"), read->info.calibration);
}

TEST_F(Reconstruct, WritesThePicturesAskedFor) {
  const ProcessResult run =
      run_bodyscan(arguments({"--output", model(), "--preview", results() / "preview.png", "--depth",
                              results() / "depth.png", "--rows", results() / "rows.png"}));
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(files_in_results(), (std::set<std::string>{"model.wrl", "preview.png", "depth.png", "rows.png"}));
  for (const char* name : {"preview.png", "depth.png", "rows.png"}) {
    const std::string file = read_text(results() / name);
    const auto picture = decode_color(std::as_bytes(std::span(file)));
    ASSERT_TRUE(picture.has_value()) << name << ": " << picture.error().message;
    std::set<Rgb8> colors(picture->pixels().begin(), picture->pixels().end());
    EXPECT_GT(colors.size(), 10U) << name << " shows nothing";
  }
}

TEST_F(Reconstruct, MaxErrorMakesFewerFaces) {
  ASSERT_EQ(run_bodyscan(arguments({"--output", model()})).status, 0);
  const fs::path coarse = results() / "coarse.wrl";
  const ProcessResult run = run_bodyscan(arguments({"--output", coarse, "--max-error", "20"}));
  ASSERT_EQ(run.status, 0) << run.error;
  const auto all = read_model(model());
  const auto fewer = read_model(coarse);
  ASSERT_TRUE(all.has_value() && fewer.has_value());
  EXPECT_LT(fewer->mesh.faces.size(), all->mesh.faces.size() / 2);
}

TEST_F(Reconstruct, ReplacesAnOlderModel) {
  write_text(model(), "old");
  ASSERT_EQ(run_bodyscan(arguments({"--output", model()})).status, 0);
  EXPECT_TRUE(read_text(model()).starts_with("#VRML V2.0 utf8\n"));
}

TEST_F(Reconstruct, PhotographsAndOtherInputsAreNotOverwritten) {
  for (const char* input : {"frame_00.png", "capture.json", "calibration.yml"}) {
    const std::string before = read_text(capture() / input);
    const ProcessResult run = run_bodyscan(arguments({"--output", model(), "--preview", capture() / input}));
    EXPECT_EQ(run.status, 2) << input;
    EXPECT_NE(run.error.find("is an input, not overwritten"), std::string::npos) << run.error;
    EXPECT_EQ(read_text(capture() / input), before);
    EXPECT_TRUE(files_in_results().empty());
  }
}

TEST_F(Reconstruct, OutputsThatCannotBeWrittenAreNamedBeforeAnythingIsComputed) {
  fs::create_directory(results() / "folder.wrl");
  write_text(results() / "plain", "");
  for (const std::string& output :
       {(results() / "nowhere" / "model.wrl").string(), (results() / "folder.wrl").string(),
        (results() / "plain" / "model.wrl").string(), std::string("/proc/model.wrl")}) {
    for (const char* option : {"--output", "--report", "--preview", "--depth", "--rows"}) {
      std::vector<std::string> more{option, output};
      if (more.front() != "--output") more.insert(more.end(), {"--output", model()});
      // A broken frame: an error about the output shows that it was found before the frames were read.
      fs::resize_file(capture() / "frame_06.png", 300);
      const ProcessResult run = run_bodyscan(arguments(more));
      EXPECT_EQ(run.status, 3) << option << ' ' << output;
      EXPECT_NE(run.error.find(output), std::string::npos) << option << ": " << run.error;
      EXPECT_EQ(files_in_results(), (std::set<std::string>{"folder.wrl", "plain"}))
          << option << ' ' << output;
    }
  }
}

TEST_F(Reconstruct, AFullDiskLeavesNothingBehind) {
  for (const rlim_t room : {0, 1000, 100'000}) {
    const ProcessResult run =
        run_bodyscan(arguments({"--output", model(), "--preview", results() / "preview.png"}), room);
    EXPECT_EQ(run.status, 3) << run.error;
    EXPECT_NE(run.error.find(results().string()), std::string::npos) << run.error;
    EXPECT_NE(run.error.find("File too large"), std::string::npos) << run.error;
    EXPECT_TRUE(files_in_results().empty());
  }
}

TEST_F(Reconstruct, AFullDeviceIsNamed) {
  const ProcessResult run = run_bodyscan(arguments({"--output", "/dev/full"}));
  EXPECT_EQ(run.status, 3);
  EXPECT_NE(run.error.find("/dev/full: "), std::string::npos) << run.error;
  EXPECT_NE(run.error.find("No space left on device"), std::string::npos) << run.error;
}

TEST_F(Reconstruct, AnyOrderOfFramesGivesTheSameModel) {
  ASSERT_EQ(run_bodyscan(arguments({"--output", model()})).status, 0);
  const std::string straight = read_text(model());
  auto manifest = nlohmann::json::parse(read_text(capture() / "capture.json"));
  std::reverse(manifest["frames"].begin(), manifest["frames"].end());
  write_text(capture() / "capture.json", manifest.dump());
  ASSERT_EQ(run_bodyscan(arguments({"--output", model()})).status, 0);
  EXPECT_EQ(read_text(model()), straight);
}

}  // namespace
}  // namespace bodyscan
