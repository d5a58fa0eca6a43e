#pragma once

#include "pipeline/calibration/calibration_report.hpp"
#include "pipeline/geometry/calibration.hpp"

#include <string>
#include <utility>
#include <vector>

namespace bodyscan {

// How a calibration was made.
struct CalibrationRun {
  std::string software;                                    // and its version
  std::vector<std::pair<std::string, double>> timings_ms;  // stage by stage, in order
};

// One JSON object with everything that the report and the calibration hold; a number that is not finite
// becomes null, and so does the sigma of a parameter that was fixed.
std::string to_json(const CalibrationReport& report, const Calibration& calibration,
                    const CalibrationRun& run);

}  // namespace bodyscan
