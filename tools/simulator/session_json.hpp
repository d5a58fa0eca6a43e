#pragma once

#include "tools/simulator/json_values.hpp"
#include "tools/simulator/session_folder.hpp"

#include <string>

namespace bodyscan::simulator {

// Names inside the session folder.
std::string printed_name(int pose, FrameFormat format);
std::string projected_name(int pose, FrameFormat format);
std::string capture_name(int pose);

// session.json.
Json session_json(const SessionTruth& truth, const SessionOptions& options);

// truth/session.json. A pose holds
//   method ("gray" or "projected"), blunders (names), board (as it was printed)
//   camera_from_board: X_camera = rotation * X_board + translation_mm
//   corners_camera_px, corners_projector_px: of every inner corner of the printed board, row by row
//   second_camera_from_board, second_corners_camera_px: the same, only where the board moved after the first
//   picture projected_corners_camera_px: of every corner of the projected board in the second picture, row by
//   row; only in
//     projected poses whose blunders leave all of them on sheet and plate
// Corners may lie outside the pictures where a blunder put them there.
Json session_truth_json(const SessionTruth& truth, const SessionOptions& options);

}  // namespace bodyscan::simulator
