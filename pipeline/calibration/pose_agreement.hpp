#pragma once

#include "pipeline/calibration/bundle_adjustment.hpp"

#include <string>
#include <vector>

namespace bodyscan {

// A pose's residuals under a calibration, its own board pose fitted to them: root mean square of the lengths,
// px.
struct PoseMisfit {
  double camera_px = 0;
  double projector_px = 0;
  RigidTransform camera_from_board;
};
PoseMisfit misfit_of_pose(const AdjustmentProblem& problem, const Adjustment& fit, std::size_t pose);

// Leaves out poses that do not agree with the rest: those whose misfit, under a calibration from the others,
// is several times theirs. Returns a reason a pose, empty for those that stay; problem.used and `fit` follow.
// At least three poses stay.
std::vector<std::string> leave_out_disagreeing(AdjustmentProblem& problem, Adjustment& fit);

}  // namespace bodyscan
