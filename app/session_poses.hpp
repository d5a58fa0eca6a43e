#pragma once

#include "app/console.hpp"
#include "hal/replay/calibration_session.hpp"
#include "pipeline/calibration/calibrate.hpp"

#include <vector>

namespace bodyscan {

// What every pose of a session shows: corners in the camera, and where the projector sees or sends them. A
// pose whose pictures show no board keeps its failure; a file that cannot be read is an error.
Expected<std::vector<CalibrationPose>> look_at_poses(const CalibrationSession& session, Progress& progress);

}  // namespace bodyscan
