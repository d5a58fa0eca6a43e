#pragma once

#include "pipeline/calibration/bundle_adjustment.hpp"

#include <string>
#include <vector>

namespace bodyscan {

constexpr int fewest_poses = 3;           // that tell everything
constexpr int fewest_kept_poses = 2;      // with kept lenses one would do, but nothing checks it
constexpr double disagreeing = 4;         // times what the other poses have
constexpr double least_misfit_px = 0.03;  // less is nothing to complain of

// Pairs of pictures are by their nature less exact than Gray-code captures: each is compared with its like.
bool is_pair(const PoseObservation& pose);

// A pose's residuals under a calibration, its own board pose fitted to them: root mean square of the lengths,
// px.
struct PoseMisfit {
  double camera_px = 0;
  double projector_px = 0;
  RigidTransform camera_from_board;
};
PoseMisfit misfit_of_pose(const AdjustmentProblem& problem, const Adjustment& fit, std::size_t pose);

// How many times larger a pose's misfit under a calibration without it is than expected: of corners as
// uncertain as `typical` says, seen with devices as uncertain as that calibration leaves them.
double surprise_of(const AdjustmentProblem& problem, const Adjustment& without, std::size_t pose,
                   const PoseMisfit& misfit, const PoseMisfit& typical);

// Leaves out poses that do not agree with the rest: those that surprise a calibration from the others.
// Returns a reason a pose, empty for those that stay; problem.used and `fit` follow. At least `fewest` poses
// stay.
std::vector<std::string> leave_out_disagreeing(AdjustmentProblem& problem, Adjustment& fit, int fewest);

}  // namespace bodyscan
