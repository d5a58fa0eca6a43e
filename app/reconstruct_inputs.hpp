#pragma once

#include "app/named_calibration.hpp"
#include "app/reconstruct.hpp"
#include "hal/replay/capture_folder.hpp"

namespace bodyscan {

// What a reconstruction reads; capture and calibration belong together.
struct ReconstructInputs {
  NamedCalibration calibration;
  CaptureFolder capture;
};

// Usage error: two results of one name, or a result named like an input. Input error: an input that is
// missing, damaged or made with another camera or projector than the other one.
Expected<ReconstructInputs> open_inputs(const ReconstructOptions& options);

}  // namespace bodyscan
