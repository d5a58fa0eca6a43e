#pragma once

#include "app/console.hpp"
#include "app/model_files.hpp"
#include "app/model_report.hpp"
#include "pipeline/base/error.hpp"

#include <filesystem>

namespace bodyscan {

struct ReconstructOptions {
  std::filesystem::path capture;      // folder
  std::filesystem::path calibration;  // file
  ModelOptions model;
};

// Decodes, triangulates, meshes, cleans, colours and saves. All output files are opened before anything is
// computed and appear only when all are complete. Errors: input (names file and place; a sequence in which
// nothing is lit too), output, and quality where lit pixels give no surface at all.
Expected<ModelReport> reconstruct(const ReconstructOptions& options, Progress& progress);

}  // namespace bodyscan
