#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/calibration/board.hpp"
#include "pipeline/calibration/calibration_report.hpp"
#include "pipeline/calibration/observations.hpp"

#include <optional>
#include <string>
#include <vector>

namespace bodyscan {

// A pose of a session: what was seen, or why nothing was.
struct CalibrationPose {
  PoseObservation observation;
  std::string failure;      // empty where something was seen
  double edge_blur_px = 0;  // of the printed board's edges, standard deviation; 0: not known
};

struct CalibrationRequest {
  PrintedBoard board;
  Size camera;
  Size projector;
  std::vector<CalibrationPose> poses;
  std::optional<Calibration> keep_intrinsics;  // estimate only where the projector stands
};

struct CalibrationResult {
  Calibration calibration;
  CalibrationReport report;
};

// Zhang's planar calibration of the camera, the projector as an inverse camera (Lanman and Taubin 2009), then
// all parameters of both devices, their relative pose and every board's pose adjusted together. Poses that do
// not agree with the others are left out and named; parameters the poses cannot tell from their defaults
// (equal focal lengths, the middle as principal point, no distortion) stay at these. Error: too few good
// poses, or poses too much alike to tell the focal lengths; the message names every bad pose and says what to
// do.
Expected<CalibrationResult> calibrate(const CalibrationRequest& request);

}  // namespace bodyscan
