#pragma once

#include "app/output_files.hpp"
#include "app/reconstruct.hpp"
#include "hal/replay/capture_folder.hpp"
#include "pipeline/geometry/calibration.hpp"
#include "pipeline/model/vrml_writer.hpp"

#include <string>

namespace bodyscan {

// Usage error: two results of one name, or a result named like an input.
Expected<void> check_paths(const ReconstructOptions& options);

// What a reconstruction reads; capture and calibration belong together.
struct ReconstructInputs {
  Calibration calibration;
  std::string calibration_name;  // the file's name and checksum
  CaptureFolder capture;
};

// Error: an input that is missing, damaged or made with another camera or projector than the other one.
Expected<ReconstructInputs> open_inputs(const ReconstructOptions& options);

// What it writes. Nothing appears under its name before `commit`.
struct ReconstructOutputs {
  VrmlWriter model;
  OptionalOutput report;
  OptionalOutput preview;
  OptionalOutput depth;
  OptionalOutput rows;

  Expected<void> commit();
};

// Error: a file that cannot be written.
Expected<ReconstructOutputs> open_outputs(const ReconstructOptions& options, const ModelInfo& info);

}  // namespace bodyscan
