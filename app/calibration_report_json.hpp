#pragma once

#include "pipeline/calibration/calibration.hpp"
#include "pipeline/calibration/calibration_report.hpp"

#include <string>

namespace bodyscan {

// One JSON object with everything that the report and the calibration hold; a number that is not finite
// becomes null, and so does the sigma of a parameter that was fixed. `software` is the version that made it.
std::string to_json(const CalibrationReport& report, const Calibration& calibration,
                    const std::string& software);

}  // namespace bodyscan
