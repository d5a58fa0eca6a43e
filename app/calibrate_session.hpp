#pragma once

#include "app/calibration_report_json.hpp"
#include "app/console.hpp"
#include "pipeline/calibration/calibrate.hpp"

#include <filesystem>
#include <optional>

namespace bodyscan {

struct CalibrateOptions {
  std::filesystem::path session;                         // folder
  std::filesystem::path output;                          // calibration file, written
  std::optional<std::filesystem::path> report;           // JSON, written
  std::optional<std::filesystem::path> plots;            // folder, SVG files written
  std::optional<std::filesystem::path> keep_intrinsics;  // calibration file: only the projector's pose is new
};

struct CalibrateOutcome {
  CalibrationResult result;
  CalibrationRun run;
};

// Reads the session, finds the boards, calibrates and writes. Outputs appear only when all is done. Errors:
// input (files, boards not found in enough poses), output.
Expected<CalibrateOutcome> calibrate_session(const CalibrateOptions& options, Progress& progress);

}  // namespace bodyscan
