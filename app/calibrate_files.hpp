#pragma once

#include "app/calibrate_session.hpp"
#include "app/output_files.hpp"
#include "hal/replay/calibration_session.hpp"
#include "pipeline/geometry/calibration.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace bodyscan {

// What a calibration reads; the lenses that are kept belong to the session's devices.
struct CalibrateInputs {
  CalibrationSession session;
  std::optional<KeptCalibration> kept;
};

// Errors: input that is missing, damaged or of other devices; usage, where a result is named like another one
// or like an input. The calibration whose lenses are kept may be replaced.
Expected<CalibrateInputs> open_inputs(const CalibrateOptions& options);

// What it writes. Nothing appears under its name before `commit`, the calibration last; a new folder for
// plots stands empty until then.
class CalibrateOutputs {
 public:
  // Error: a file that cannot be written, a folder that cannot be made.
  static Expected<CalibrateOutputs> open(const CalibrateOptions& options);

  Expected<void> write(const CalibrateOutcome& outcome, const CalibrateInputs& inputs);
  Expected<void> commit();

 private:
  explicit CalibrateOutputs(AtomicFile calibration) : calibration_(std::move(calibration)) {}
  Expected<void> open_plots(const std::filesystem::path& folder);
  Expected<void> draw_plots(const CalibrationResult& result, const PrintedBoard& board);

  AtomicFile calibration_;
  OptionalOutput report_;
  std::optional<OutputFolder> plots_folder_;
  std::vector<AtomicFile> plots_;  // in plots_folder_, as plot_file_names
};

}  // namespace bodyscan
