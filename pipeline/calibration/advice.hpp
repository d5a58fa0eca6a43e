#pragma once

#include "pipeline/calibration/parameter_selection.hpp"

#include <string>
#include <vector>

namespace bodyscan {

// What is wrong with how the board was held, in words and figures.
std::vector<std::string> advise_on_poses(const AdjustmentProblem& problem, const Adjustment& fit);

// That, what the poses cannot determine, and which further pose of the board would help most: of a set of
// tilts, places and distances, the one after which the focal lengths and the baseline are known best.
std::vector<std::string> advise(const AdjustmentProblem& problem, const SupportedFit& supported);

// For every pose a note if its board was held as in a pose before it; else nothing.
std::vector<std::string> name_repeated(const AdjustmentProblem& problem,
                                       const std::vector<RigidTransform>& camera_from_board);

// Poses that are used, those counted once in which the board was not moved at all.
int different_poses(const AdjustmentProblem& problem, const std::vector<RigidTransform>& camera_from_board);

}  // namespace bodyscan
