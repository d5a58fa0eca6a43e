#include "tools/simulator/session_folder.hpp"

#include "hal/replay/calibration_session.hpp"
#include "pipeline/calibration/calibration_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_files.hpp"
#include "tests/tools/simulator/session_test_support.hpp"
#include "tools/simulator/image_files.hpp"

#include <functional>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bodyscan::simulator {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector2d;
using nlohmann::json;

Vector2d pixel_of(const json& pixel) {
  return {pixel.at(0).get<double>(), pixel.at(1).get<double>()};
}

RigidTransform transform_of(const json& transform) {
  RigidTransform read;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    read.translation[i] = transform.at("translation_mm").at(k);
    for (int j = 0; j < 3; ++j)
      read.rotation(i, j) = transform.at("rotation").at(k).at(static_cast<std::size_t>(j));
  }
  return read;
}

class SessionFolder : public testing::Test {
 protected:
  SessionFolder() { options_.render.output = folder_; }

  [[nodiscard]] json truth_json() const { return json::parse(read_text(folder_ / "truth" / "session.json")); }

  TemporaryFolder temporary_;
  fs::path folder_ = temporary_ / "session";
  SessionOptions options_ = small_session(SessionMethod::mixed);
};

TEST_F(SessionFolder, IsACalibrationSession) {
  options_.poses = 3;
  options_.render.rays = 1;
  options_.render.rig.projector = {64, 48};
  options_.projected_share = 1;
  const Expected<SessionTruth> truth = render_session(options_);
  ASSERT_TRUE(truth) << truth.error().message;
  const Expected<CalibrationSession> session = CalibrationSession::open(folder_);
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_EQ(session->size(), (Size{429, 285}));
  const SessionManifest& manifest = session->manifest();
  EXPECT_EQ(manifest.board.columns, 9);
  EXPECT_EQ(manifest.board.rows, 7);
  EXPECT_EQ(manifest.board.square_mm, 25);
  EXPECT_EQ(manifest.projector, (Size{64, 48}));
  ASSERT_TRUE(manifest.projected_board);
  EXPECT_EQ(manifest.projected_board->columns, 9);
  EXPECT_EQ(manifest.projected_board->rows, 7);
  EXPECT_EQ(manifest.projected_board->square_px, truth->projected.square_px);
  EXPECT_EQ(manifest.projected_board->first_corner_px, truth->projected.first_corner_px);
  ASSERT_EQ(session->pose_count(), 3);
  EXPECT_EQ(manifest.poses[0].printed, "pose_0_printed.png");
  EXPECT_EQ(manifest.poses[2].projected, "pose_2_projected.png");
  EXPECT_EQ(manifest.poses[1].capture, "pose_1");

  const CaptureFolder& capture = session->capture(1);
  ASSERT_EQ(capture.frame_count(), 2 + 2 * (6 + 6));
  EXPECT_EQ(capture.manifest().frames[0].pattern.kind, PatternKind::white);
  EXPECT_EQ(capture.manifest().frames[0].file,
            "frame_00.png");  // the first picture, the one before a blunder
  for (int i = 0; i < capture.frame_count(); ++i) EXPECT_TRUE(capture.load(i)) << i;

  const Calibration rig = read_calibration(folder_ / "calibration.yml").value();
  EXPECT_EQ(rig.camera.fx, truth->calibration.camera.fx);
  EXPECT_EQ(rig.projector.distortion, truth->calibration.projector.distortion);
  EXPECT_EQ(rig.projector_from_camera.translation, truth->calibration.projector_from_camera.translation);
}

TEST_F(SessionFolder, TruthHoldsWhereTheCornersOfThePicturesAre) {
  options_.method = SessionMethod::projected;
  options_.poses = 1;
  options_.render = even_light(options_.render);
  const SessionTruth truth = render_session(options_).value();
  const json pose = truth_json().at("poses").at(0);
  EXPECT_EQ(pose.at("method"), "projected");
  EXPECT_EQ(pose.at("blunders"), json::array());
  EXPECT_EQ(pose.at("board"), (json{{"columns", 9}, {"rows", 7}, {"square_mm", 25}}));
  EXPECT_FALSE(pose.contains("second_camera_from_board"));
  const RigidTransform camera_from_board = transform_of(pose.at("camera_from_board"));
  EXPECT_EQ(camera_from_board.rotation, truth.poses[0].first_camera_from_board.rotation);
  EXPECT_EQ(camera_from_board.translation, truth.poses[0].first_camera_from_board.translation);

  const ColorImage8 printed = read_color_image(folder_ / "pose_0_printed.png").value();
  EXPECT_LT(largest_edge_error(printed, truth.calibration.camera, truth.poses[0].sheet, camera_from_board),
            0.07);

  ASSERT_EQ(pose.at("corners_camera_px").size(), 63U);
  ASSERT_EQ(pose.at("corners_projector_px").size(), 63U);
  ASSERT_EQ(pose.at("projected_corners_camera_px").size(), 63U);
  const Calibration& rig = truth.calibration;
  const auto projected = projected_corners(rig, truth.projected, truth.poses[0].sheet, camera_from_board);
  for (int index = 0; index < 63; ++index) {
    const auto i = static_cast<std::size_t>(index);
    const Vector2d in_camera = pixel_of(pose.at("corners_camera_px").at(i));
    const Eigen::Vector3d corner = camera_from_board * Eigen::Vector3d(25 * (index % 9), 25 * (index / 9), 0);
    EXPECT_LT((in_camera - rig.camera.project(corner)).norm(), 1e-9);
    const Vector2d in_second = pixel_of(pose.at("projected_corners_camera_px").at(i));
    EXPECT_LT((in_second - rig.camera.project(projected[i])).norm(), 1e-9);
    EXPECT_LT((pixel_of(pose.at("corners_projector_px").at(i)) -
               rig.projector.project(rig.projector_from_camera * corner))
                  .norm(),
              1e-9);
  }
}

TEST_F(SessionFolder, TruthNamesTheBlundersAndBothPlacesOfAMovedBoard) {
  options_.method = SessionMethod::projected;
  options_.poses = 2;
  options_.blunders = {{1, Blunder::moved}, {1, Blunder::scaled}};
  const SessionTruth truth = render_session(options_).value();
  const json poses = truth_json().at("poses");
  EXPECT_FALSE(poses.at(0).contains("second_camera_from_board"));
  const json& pose = poses.at(1);
  EXPECT_EQ(pose.at("blunders"), (json{"moved", "scaled"}));
  EXPECT_EQ(pose.at("board").at("square_mm"), 26);
  const RigidTransform second = transform_of(pose.at("second_camera_from_board"));
  EXPECT_EQ(second.translation, truth.poses[1].second_camera_from_board.translation);
  for (int i = 0; i < 63; ++i) {
    const Vector2d wanted = corner_pixel(truth.calibration.camera, truth.poses[1].sheet, second, i);
    const json& pixel = pose.at("second_corners_camera_px").at(static_cast<std::size_t>(i));
    EXPECT_LT((pixel_of(pixel) - wanted).norm(), 1e-9);
  }
  // The session itself tells nothing of it.
  EXPECT_EQ(CalibrationSession::open(folder_)->manifest().board.square_mm, 25);
}

TEST_F(SessionFolder, GrayCodeAloneNeedsNoProjectedBoard) {
  options_.method = SessionMethod::gray;
  options_.poses = 1;
  options_.render.rays = 1;
  options_.render.rig.projector = {16, 16};
  options_.render.format = FrameFormat::jpeg;
  ASSERT_TRUE(render_session(options_));
  const CalibrationSession session = CalibrationSession::open(folder_).value();
  EXPECT_FALSE(session.manifest().projected_board);
  EXPECT_EQ(session.capture(0).manifest().frames[0].file, "frame_00.jpg");
  const json truth = truth_json();
  EXPECT_FALSE(truth.contains("projected_board"));
  EXPECT_EQ(truth.at("poses").at(0).at("method"), "gray");
  EXPECT_FALSE(truth.at("poses").at(0).contains("projected_corners_camera_px"));
}

TEST_F(SessionFolder, ABlunderInACaptureComesAfterItsFirstFrame) {
  options_.method = SessionMethod::gray;
  options_.poses = 1;
  options_.render.rays = 1;
  options_.render.rig.projector = {16, 16};
  const auto frames = [&](const char* name) {
    options_.render.output = temporary_ / name;
    EXPECT_TRUE(render_session(options_));
    return snapshot(options_.render.output / "pose_0");
  };
  const auto sound = frames("sound");
  options_.blunders = {{0, Blunder::moved}};
  const auto moved = frames("moved");
  ASSERT_EQ(sound.size(), 1U + 2 + 2 * (4 + 4));
  ASSERT_EQ(moved.size(), sound.size());
  for (const auto& [name, content] : sound)
    EXPECT_EQ(content == moved.at(name), name == "frame_00.png" || name == "capture.json") << name;
}

TEST_F(SessionFolder, ABlunderInAPairComesAfterItsPrintedPicture) {
  options_.method = SessionMethod::projected;
  options_.poses = 1;
  const auto pictures = [&](const char* name) {
    options_.render.output = temporary_ / name;
    EXPECT_TRUE(render_session(options_));
    return snapshot(options_.render.output);
  };
  const auto sound = pictures("sound");
  options_.blunders = {{0, Blunder::moved}};
  const auto moved = pictures("moved");
  EXPECT_TRUE(sound.at("pose_0_printed.png") == moved.at("pose_0_printed.png"));
  EXPECT_FALSE(sound.at("pose_0_projected.png") == moved.at("pose_0_projected.png"));
  EXPECT_FALSE(sound.at("pose_0_printed.png") == sound.at("pose_0_projected.png"));
}

TEST_F(SessionFolder, ABadOptionWritesNothing) {
  const std::vector<std::pair<std::string, std::function<void(SessionOptions&)>>> cases{
      {"--output", [](SessionOptions& o) { o.render.output.clear(); }},
      {"--poses", [](SessionOptions& o) { o.poses = 0; }},
      {"--calibration: no built-in rig", [](SessionOptions& o) { o.render.calibration = "builtin:left"; }},
      {"--columns, --rows", [](SessionOptions& o) { o.board.square_mm = 60; }},
  };
  for (const auto& [wanted, spoil] : cases) {
    SessionOptions options = options_;
    spoil(options);
    const Expected<SessionTruth> truth = render_session(options);
    ASSERT_FALSE(truth) << wanted;
    EXPECT_EQ(truth.error().kind, ErrorKind::usage);
    EXPECT_TRUE(truth.error().message.starts_with(wanted)) << truth.error().message;
    EXPECT_FALSE(fs::exists(folder_));
  }
}

TEST_F(SessionFolder, AFileInTheWayIsAnErrorThatNamesIt) {
  options_.method = SessionMethod::gray;
  options_.poses = 1;
  options_.render.rays = 1;
  options_.render.rig.projector = {16, 16};
  write_text(temporary_ / "file", "in the way");
  options_.render.output = temporary_ / "file" / "session";
  Expected<SessionTruth> truth = render_session(options_);
  ASSERT_FALSE(truth);
  EXPECT_EQ(truth.error().kind, ErrorKind::output);
  EXPECT_NE(truth.error().message.find("file/session"), std::string::npos);

  options_.render.output = folder_;
  fs::create_directories(folder_);
  write_text(folder_ / "pose_0", "in the way");
  truth = render_session(options_);
  ASSERT_FALSE(truth);
  EXPECT_EQ(truth.error().kind, ErrorKind::output);
  EXPECT_NE(truth.error().message.find("session/pose_0"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "session.json"));
}

}  // namespace
}  // namespace bodyscan::simulator
