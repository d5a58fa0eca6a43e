#pragma once

#include "pipeline/calibration/calibrate.hpp"
#include "pipeline/calibration/rig_model.hpp"

#include <vector>

namespace bodyscan {

// Whether any of the poses that are used is a pair of pictures, or a Gray-code capture.
bool has_pairs(const std::vector<PoseObservation>& poses, const std::vector<bool>& used);
bool has_captures(const std::vector<PoseObservation>& poses, const std::vector<bool>& used);

// What the adjustment starts from.
struct StartingPoint {
  std::vector<PoseObservation> poses;  // the projected boards the right way round
  RigEstimate rig;
};

// A projected board looks the same upside down, a square one from all four sides. Which way it stands is told
// by the Gray-code poses that are used, else it is as find_projected_board counts. Error: the poses allow no
// guess.
Expected<StartingPoint> start_whole(const CalibrationRequest& request, const std::vector<bool>& used);

// With kept lenses: every board where the camera sees it, the projector where they tell. Which way a
// projected board stands is told by Gray-code poses, else by where the projector stood.
Expected<StartingPoint> start_from_kept(const CalibrationRequest& request, const std::vector<bool>& used);

}  // namespace bodyscan
