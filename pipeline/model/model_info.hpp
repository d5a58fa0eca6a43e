#pragma once

#include <string>

namespace bodyscan {

// What a model file says about itself; never anything about the patient.
struct ModelInfo {
  std::string calibration;  // which calibration the points were measured with
  std::string software;     // program and version that made the model
  std::string comment;
  bool closed = false;  // the faces enclose a volume, so that their backs need no drawing

  friend bool operator==(const ModelInfo&, const ModelInfo&) = default;
};

}  // namespace bodyscan
