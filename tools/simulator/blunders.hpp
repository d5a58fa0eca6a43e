#pragma once

#include "tools/simulator/session_poses.hpp"

namespace bodyscan::simulator {

// Makes a planned pose a bad one.
void plant(Blunder kind, const Calibration& calibration, SessionPose& pose);

}  // namespace bodyscan::simulator
