#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/board/board.hpp"
#include "pipeline/board/observations.hpp"
#include "pipeline/calibration/calibration_report.hpp"

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

// A calibration whose lenses still hold, and how well it fitted when it was made, px; 0: not known.
struct KeptCalibration {
  Calibration calibration;
  double camera_rms_px = 0;
  double projector_rms_px = 0;
};

struct CalibrationRequest {
  PrintedBoard board;
  Size camera;
  Size projector;
  std::optional<ProjectedBoard> projected_board;  // of poses that are pairs of pictures
  std::vector<CalibrationPose> poses;
  std::optional<KeptCalibration> kept;  // estimate only where the projector stands
};

struct CalibrationResult {
  Calibration calibration;
  CalibrationReport report;
};

// Zhang's planar calibration of the camera, the projector as an inverse camera (Lanman and Taubin 2009), then
// all parameters of both devices, their relative pose and every board's pose adjusted together. Poses that do
// not agree with the others are left out and named; parameters the poses cannot tell from their defaults
// (equal focal lengths, the middle as principal point, no distortion) stay at these. A projected board may
// look the same upside down; which way it stands is told by Gray-code poses, else by the kept calibration,
// else it is as find_projected_board counts. Error: too few good poses, or poses that contradict one another
// or are too much alike to tell the focal lengths, or kept lenses that do not fit; the message names every
// bad pose and says what to do.
Expected<CalibrationResult> calibrate(const CalibrationRequest& request);

}  // namespace bodyscan
