#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/geometry/calibration.hpp"
#include "tools/simulator/printed_sheet.hpp"
#include "tools/simulator/session_options.hpp"

#include <vector>

namespace bodyscan::simulator {

inline constexpr int most_session_poses = 14;

// How the board stands and is lit while one pose is shot. What comes first is the picture of the printed
// board (a capture's white frame), what comes second the picture with the projected one (all other frames).
struct SessionPose {
  bool gray = false;  // a Gray-code capture, not a pair of pictures
  PrintedSheet sheet;
  RigidTransform first_camera_from_board;
  RigidTransform second_camera_from_board;
  double first_light = 1;  // RenderOptions::light
  double second_light = 1;
  double lens_blur = 0;  // camera px
  std::vector<Blunder> blunders;
};

// A projected board of 9 x 7 inner corners that spans the wanted share of the projector's picture, or as much
// of it as lets the camera see every square in every pose, with the printed board in the middle of the
// picture.
Expected<ProjectedBoard> plan_projected_board(const SessionOptions& options, const Calibration& calibration);

// The session's poses, before blunders: tilted up to 35 degrees to each side, turned up to 20, 0.9 to 1.2 m
// away, and as far towards the picture's borders as camera and projector both see the whole sheet, and in
// projected poses the camera all projected squares on sheet and plate. An error of kind `usage` if a pose
// cannot be seen at all.
Expected<std::vector<SessionPose>> plan_poses(const SessionOptions& options, const Calibration& calibration,
                                              const ProjectedBoard& projected);

// Where each projected corner falls on the sheet and its plate, in the camera frame; an empty vector if one
// misses.
std::vector<Eigen::Vector3d> projected_corners(const Calibration& calibration,
                                               const ProjectedBoard& projected, const PrintedSheet& sheet,
                                               const RigidTransform& camera_from_board);

}  // namespace bodyscan::simulator
