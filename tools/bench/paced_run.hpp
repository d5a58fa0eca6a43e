#pragma once

#include "pipeline/base/error.hpp"

#include <filesystem>

namespace bodyscan {

// A capture whose frames arrive one by one, as from a camera, while the product's decoder takes them; then
// the rest of the reconstruction. Times in seconds.
struct PacedRun {
  int frames = 0;
  double correspondence_s = 0;  // from the last frame's arrival to the complete correspondence
  double model_s = 0;           // from the last frame's arrival to the finished model file
  double frame_s = 0;           // longest time that a frame other than the last took
  double compute_s = 0;         // time of all computing: every frame's and what follows
};

// The frames arrive (as files in memory) every `interval_s`; the calibration is the folder's own. A frame
// that is not done when the next arrives makes that one wait.
Expected<PacedRun> run_paced(const std::filesystem::path& capture, const std::filesystem::path& model,
                             double interval_s);

}  // namespace bodyscan
