#include "tools/simulator/capture_folder.hpp"

#include "pipeline/calibration/calibration_file.hpp"
#include "tools/simulator/image_files.hpp"
#include "tools/simulator/obj_file.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bodyscan::simulator {
namespace {

namespace fs = std::filesystem;

class CaptureFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / (std::string("simulator_capture_") +
                                              testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] RenderOptions small(const std::string& subject) const {
    RenderOptions options;
    options.subject = subject;
    options.rig.scale = 1.0 / 16;
    options.rig.projector = {64, 48};
    options.detail = 5;
    options.output = folder_ / "capture";
    return options;
  }
  [[nodiscard]] nlohmann::json read_json(const fs::path& name) const {
    return nlohmann::json::parse(std::ifstream(folder_ / "capture" / name));
  }

  fs::path folder_;
};

TEST_F(CaptureFolder, HoldsTheSequenceTheCalibrationAndTheTruth) {
  const RenderOptions options = small("builtin:staircase");
  const Truth truth = render_capture(options).value();
  const nlohmann::json capture = read_json("capture.json");
  EXPECT_EQ(capture["format"], "bodyscan-capture");
  EXPECT_EQ(capture["version"], 1);
  EXPECT_EQ(capture["projector"]["height"], 48);
  ASSERT_EQ(capture["frames"].size(), 2U + 2 * 6);
  EXPECT_EQ(capture["frames"][0]["pattern"], "white");
  EXPECT_EQ(
      capture["frames"][3],
      (nlohmann::json{
          {"file", "frame_03.jpg"}, {"pattern", "gray"}, {"axis", "row"}, {"bit", 5}, {"inverted", true}}));
  for (const auto& frame : capture["frames"])
    EXPECT_EQ(read_color_image(options.output / frame["file"].get<std::string>()).value().size(),
              (Size{268, 178}));
  const Calibration calibration = read_calibration(options.output / "calibration.yml").value();
  EXPECT_EQ(calibration.camera.size, truth.scene.calibration.camera.size);
  EXPECT_LT((calibration.projector_from_camera.translation -
             truth.scene.calibration.projector_from_camera.translation)
                .norm(),
            1e-9);
  for (const char* name : {"depth.pfm", "normal.pfm", "rows.pfm", "columns.pfm", "reachable.png", "mesh.obj"})
    EXPECT_TRUE(fs::exists(options.output / "truth" / name)) << name;
  const nlohmann::json scene = read_json("truth/scene.json");
  EXPECT_EQ(scene["steps"].size(), 4U);
  EXPECT_EQ(scene["steps"][3]["height_mm"], 106);
  EXPECT_NEAR(scene["steps"][3]["point"][2].get<double>(), 1024, 1e-9);
  EXPECT_EQ(scene["settings"]["jpeg_quality"], 95);
}

TEST_F(CaptureFolder, WritesBothAxesWithoutInversesAsPng) {
  RenderOptions options = small("builtin:staircase");
  options.sequence = {true, true, false};
  options.format = FrameFormat::png;
  options.write_mesh = false;
  ASSERT_TRUE(render_capture(options));
  const nlohmann::json capture = read_json("capture.json");
  ASSERT_EQ(capture["frames"].size(), 2U + 6 + 6);
  EXPECT_EQ(capture["frames"][13]["file"], "frame_13.png");
  EXPECT_EQ(capture["frames"][13]["axis"], "column");
  EXPECT_TRUE(read_color_image(options.output / "frame_13.png"));
  EXPECT_FALSE(fs::exists(options.output / "truth" / "mesh.obj"));
}

TEST_F(CaptureFolder, DepthMapStartsWithTheBottomRow) {
  const RenderOptions options = small("builtin:spheres");
  const Truth truth = render_capture(options).value();
  std::ifstream file(options.output / "truth" / "depth.pfm", std::ios::binary);
  std::string magic;
  int width = 0;
  int height = 0;
  double scale = 0;
  file >> magic >> width >> height >> scale;
  file.get();
  EXPECT_EQ(magic, "Pf");
  EXPECT_EQ(scale, -1);
  ASSERT_EQ((Size{width, height}), truth.maps.depth.size());
  std::vector<float> values(truth.maps.depth.size().area());
  file.read(reinterpret_cast<char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(float)));
  ASSERT_TRUE(file);
  int surface = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float value = values[static_cast<std::size_t>((height - 1 - y) * width + x)];
      ASSERT_EQ(value, truth.maps.depth(x, y));
      surface += value > 0;
    }
  }
  EXPECT_GT(surface, 1000);
}

TEST_F(CaptureFolder, FactsFollowThePoseAndScale) {
  RenderOptions options = small("builtin:spheres");
  const Truth plain = render_capture(options).value();
  options.pose_rotation = {0, 0, 90};
  options.pose_translation = {5, 6, 7};
  options.subject_scale = 0.5;
  const Truth posed = render_capture(options).value();
  const SphereFact& before = plain.scene.subject.facts.spheres[0];
  const SphereFact& after = posed.scene.subject.facts.spheres[0];
  const Eigen::Vector3d from_origin = before.center - Eigen::Vector3d(0, 0, 1050);
  EXPECT_LT((after.center - (Eigen::Vector3d(-from_origin.y(), from_origin.x(), from_origin.z()) / 2 +
                             Eigen::Vector3d(5, 6, 1057)))
                .norm(),
            1e-9);
  EXPECT_EQ(after.radius, 15);
  // The rendered surface goes with them.
  const Eigen::Vector2d pixel = posed.scene.calibration.camera.project(after.center);
  const double front = static_cast<double>(
      posed.maps.depth(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y()))));
  EXPECT_NEAR(front, after.center.z() - 15, 0.5);
}

TEST_F(CaptureFolder, TheMeshIsASubjectAgain) {
  const RenderOptions options = small("builtin:forearm");
  const Truth truth = render_capture(options).value();
  const Subject again = read_obj(options.output / "truth" / "mesh.obj").value();
  EXPECT_EQ(again.mesh.triangles.size(), truth.scene.subject.mesh.triangles.size());
  EXPECT_NEAR(again.mesh.albedo[0].x(), 0.72, 0.08);
  const nlohmann::json scene = read_json("truth/scene.json");
  ASSERT_EQ(scene["moles"].size(), truth.scene.subject.facts.moles.size());
  EXPECT_EQ(scene["moles"][0]["diameter_mm"], 4);
}

TEST_F(CaptureFolder, RendersFromACalibrationFile) {
  const RigOptions rig{.name = "columns", .scale = 1.0 / 16, .projector = {64, 48}, .projector_roll = 0};
  fs::create_directories(folder_);
  ASSERT_TRUE(write_calibration(make_rig(rig).value(), folder_ / "rig.yml"));
  RenderOptions options = small("builtin:staircase");
  options.calibration = (folder_ / "rig.yml").string();
  const Truth from_file = render_capture(options).value();
  options.calibration = "builtin:columns";
  const Truth builtin = render_capture(options).value();
  const auto depth = from_file.maps.depth.pixels();
  EXPECT_TRUE(std::equal(depth.begin(), depth.end(), builtin.maps.depth.pixels().begin()));
}

TEST_F(CaptureFolder, AnUnwritableFolderIsAnErrorThatNamesIt) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "file") << "in the way";
  RenderOptions options = small("builtin:staircase");
  options.output = folder_ / "file" / "capture";
  const Expected<Truth> truth = render_capture(options);
  ASSERT_FALSE(truth);
  EXPECT_EQ(truth.error().kind, ErrorKind::output);
  EXPECT_NE(truth.error().message.find("file/capture"), std::string::npos);
}

TEST_F(CaptureFolder, ABadOptionWritesNothing) {
  RenderOptions options = small("builtin:staircase");
  options.jpeg_quality = 0;
  const Expected<Truth> truth = render_capture(options);
  ASSERT_FALSE(truth);
  EXPECT_TRUE(truth.error().message.starts_with("--jpeg-quality"));
  EXPECT_FALSE(fs::exists(options.output));
}

}  // namespace
}  // namespace bodyscan::simulator
