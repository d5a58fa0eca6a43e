#pragma once

#include "pipeline/calibration/bundle_adjustment.hpp"
#include "pipeline/calibration/calibration_report.hpp"
#include "pipeline/calibration/parameter_selection.hpp"

#include <string>
#include <vector>

namespace bodyscan {

// What a fit is worth: everything but the advice and what needs further fits. `reasons` (a pose each) say why
// poses are not used.
CalibrationReport report_of(const AdjustmentProblem& problem, const SupportedFit& supported,
                            const std::vector<std::string>& reasons);

// The figures of poses under calibrations from the other poses, where there are others. Returns the largest
// surprise (see surprise_of) among them; 0 for a single pose.
double report_leave_one_out(const AdjustmentProblem& problem, const Adjustment& fit,
                            CalibrationReport& report);

}  // namespace bodyscan
