#include "tools/simulator/session_json.hpp"

#include "tools/simulator/frame_file.hpp"

#include <utility>

namespace bodyscan::simulator {
namespace {

Json size_json(Size size) {
  return {{"width", size.width}, {"height", size.height}};
}

Json board_json(const PrintedBoard& board) {
  return {{"columns", board.columns}, {"rows", board.rows}, {"square_mm", board.square_mm}};
}

Json projected_json(const ProjectedBoard& board) {
  return {{"columns", board.columns},
          {"rows", board.rows},
          {"first_corner_px", pixel_json(board.first_corner_px)},
          {"square_px", board.square_px}};
}

Json transform_json(const RigidTransform& transform) {
  return {{"rotation", matrix_json(transform.rotation)}, {"translation_mm", to_json(transform.translation)}};
}

// Points of the camera frame as `lens` sees them.
Json pixels_json(const std::vector<Eigen::Vector3d>& points, const Lens& lens,
                 const RigidTransform& lens_from_camera) {
  Json pixels = Json::array();
  for (const Eigen::Vector3d& point : points)
    pixels.push_back(pixel_json(lens.project(lens_from_camera * point)));
  return pixels;
}

std::vector<Eigen::Vector3d> printed_corners(const PrintedSheet& sheet,
                                             const RigidTransform& camera_from_board) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < sheet.board().corner_count(); ++i)
    corners.push_back(camera_from_board * sheet.point(sheet.board().corner_mm(i)));
  return corners;
}

Json pose_json(const SessionPose& pose, const SessionTruth& truth) {
  const Calibration& calibration = truth.calibration;
  const RigidTransform none;
  const auto corners = printed_corners(pose.sheet, pose.first_camera_from_board);
  Json blunders = Json::array();
  bool moved = false;
  for (const Blunder kind : pose.blunders) {
    blunders.push_back(name_of(kind));
    moved = moved || kind == Blunder::moved;
  }
  Json json{{"method", pose.gray ? "gray" : "projected"},
            {"blunders", std::move(blunders)},
            {"board", board_json(pose.sheet.board())},
            {"camera_from_board", transform_json(pose.first_camera_from_board)},
            {"corners_camera_px", pixels_json(corners, calibration.camera, none)},
            {"corners_projector_px",
             pixels_json(corners, calibration.projector, calibration.projector_from_camera)}};
  if (moved) {
    json["second_camera_from_board"] = transform_json(pose.second_camera_from_board);
    json["second_corners_camera_px"] =
        pixels_json(printed_corners(pose.sheet, pose.second_camera_from_board), calibration.camera, none);
  }
  if (pose.gray) return json;
  const auto projected =
      projected_corners(calibration, truth.projected, pose.sheet, pose.second_camera_from_board);
  if (!projected.empty())
    json["projected_corners_camera_px"] = pixels_json(projected, calibration.camera, none);
  return json;
}

Json settings_json(const SessionOptions& options) {
  Json settings{{"bend_mm", options.bend_mm},
                {"plate_mm", options.plate_mm},
                {"projected_share", options.projected_share}};
  settings.update(rig_and_camera_json(options.render));
  return settings;
}

}  // namespace

std::string printed_name(int pose, FrameFormat format) {
  return "pose_" + std::to_string(pose) + "_printed" + extension(format);
}

std::string projected_name(int pose, FrameFormat format) {
  return "pose_" + std::to_string(pose) + "_projected" + extension(format);
}

std::string capture_name(int pose) {
  return "pose_" + std::to_string(pose);
}

Json session_json(const SessionTruth& truth, const SessionOptions& options) {
  Json poses = Json::array();
  for (int i = 0; i < static_cast<int>(truth.poses.size()); ++i) {
    if (truth.poses[static_cast<std::size_t>(i)].gray) {
      poses.push_back({{"capture", capture_name(i)}});
    } else {
      const FrameFormat format = options.render.format;
      poses.push_back({{"printed", printed_name(i, format)}, {"projected", projected_name(i, format)}});
    }
  }
  Json session{{"format", "bodyscan-calibration-session"},
               {"version", 1},
               {"board", board_json(options.board)},
               {"projector", size_json(truth.calibration.projector.size)}};
  if (truth.projected.square_px > 0) session["projected_board"] = projected_json(truth.projected);
  session["poses"] = std::move(poses);
  return session;
}

Json session_truth_json(const SessionTruth& truth, const SessionOptions& options) {
  Json poses = Json::array();
  for (const SessionPose& pose : truth.poses) poses.push_back(pose_json(pose, truth));
  Json session{{"format", "bodyscan-simulated-session"}, {"version", 1}};
  if (truth.projected.square_px > 0) session["projected_board"] = projected_json(truth.projected);
  session["poses"] = std::move(poses);
  session["settings"] = settings_json(options);
  return session;
}

}  // namespace bodyscan::simulator
