#pragma once

#include "app/console.hpp"
#include "app/model_files.hpp"
#include "app/model_report.hpp"
#include "app/scan/shooting.hpp"
#include "hal/camera.hpp"
#include "hal/projector.hpp"
#include "hal/rig/rig_file.hpp"
#include "pipeline/base/error.hpp"
#include "pipeline/capture_check/motion_watch.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace bodyscan {

struct ScanOptions {
  Rig rig;
  ModelOptions model;
  std::optional<std::filesystem::path> photographs;  // folder to keep the photographs in, as a capture
};

// The station that scans.
struct Station {
  Camera& camera;
  Projector& projector;
  std::function<Expected<void>()> stop;  // gives an error once the scan is to end; called from a thread
  Patience patience = {};
};

struct ScanReport {
  ModelReport model;
  ShootingReport shooting;
  std::vector<std::string> refused;  // shots that were made again, with their reasons
  SequenceMotion motion;
  double motion_mm = 0;
  int shot_again_for_motion = 0;
  double light_s = 0;             // that the projector shone
  double after_last_shot_ms = 0;  // until the model was written
  CameraIdentity camera;
  CameraSettings settings;
};

// The reconstruct report's keys and those of a scan.
std::string to_json(const ScanReport& report);

// Shows, shoots, decodes and makes the model. The projector is dark when it returns. A subject that moved by
// more than the rig allows is shot again, as much of it as is needed, once; if it moved again the error is of
// kind `quality`, the report is written and no model. Other errors: input, output, device.
Expected<ScanReport> scan(const ScanOptions& options, const Station& station, Progress& progress);

}  // namespace bodyscan
