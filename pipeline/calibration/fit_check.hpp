#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/calibration/bundle_adjustment.hpp"
#include "pipeline/calibration/calibrate.hpp"

#include <optional>
#include <string>

namespace bodyscan {

// Whether a fit may be used. Each is an input error that says what to do.

// The poses tell the focal lengths, and the values describe devices.
Expected<void> check_focal_lengths(const AdjustmentProblem& problem, const Adjustment& fit);

// One camera and one projector could have seen these poses.
Expected<void> check_fit(const AdjustmentProblem& problem, const CalibrationReport& report);

// The poses do not contradict one another, so that which one is bad cannot be told. `surprise` as
// report_leave_one_out gives it.
Expected<void> check_agreement(const AdjustmentProblem& problem, const Adjustment& fit, double surprise,
                               const CalibrationReport& report);

// Lenses that were kept still hold.
Expected<void> check_kept(const AdjustmentProblem& problem, const CalibrationReport& report,
                          const KeptCalibration& kept);

// Words for a projector that is not where it was before, nor near.
std::optional<std::string> far_move(const RigidTransform& now, const RigidTransform& before);

}  // namespace bodyscan
