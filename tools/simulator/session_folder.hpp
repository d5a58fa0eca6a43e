#pragma once

#include "tools/simulator/session_poses.hpp"

#include <vector>

namespace bodyscan::simulator {

// What is known about a rendered session.
struct SessionTruth {
  Calibration calibration;
  ProjectedBoard projected;  // square_px 0: no pose needs it
  std::vector<SessionPose> poses;
};

// The poses of a session, blunders included. Checks the options and reads the calibration.
Expected<SessionTruth> plan_session(const SessionOptions& options);

// Renders a calibration session folder (session.json and its pictures), and beside it calibration.yml, the
// true calibration, and truth/session.json, the true poses and corners (see session_json.hpp).
Expected<SessionTruth> render_session(const SessionOptions& options);

}  // namespace bodyscan::simulator
