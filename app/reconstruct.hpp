#pragma once

#include "app/console.hpp"
#include "pipeline/base/error.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bodyscan {

struct ReconstructOptions {
  std::filesystem::path capture;                 // folder
  std::filesystem::path calibration;             // file
  std::filesystem::path model;                   // VRML, written
  std::optional<std::filesystem::path> report;   // JSON, written
  std::optional<std::filesystem::path> preview;  // PNG, written: the shaded model
  std::optional<std::filesystem::path> depth;    // PNG, written: depth in false colour
  std::optional<std::filesystem::path> rows;     // PNG, written: projector rows in false colour
  std::optional<double> max_error_mm;  // simplify the surface by at most this; else keep every point
};

struct ReconstructReport {
  std::size_t points = 0;
  std::size_t faces = 0;
  std::size_t pixels_lit = 0;
  std::size_t pixels_decoded = 0;
  std::vector<std::pair<std::string, std::size_t>> artifacts_removed;  // reason and how many
  double mean_uncertainty_mm = 0;                                      // of the model's points, along the ray
  std::vector<std::pair<std::string, double>> timings_ms;              // stage by stage, in order
  std::size_t peak_memory_bytes = 0;
  std::string software;
  std::string calibration;  // the file's name and checksum
};

// One JSON object with the keys of the reconstruct report.
std::string to_json(const ReconstructReport& report);

// Decodes, triangulates, meshes, cleans, colours and saves. All output files are opened before anything is
// computed and appear only when all are complete. Errors: input (names file and place; a sequence in which
// nothing is lit too), output, and quality where lit pixels give no surface at all.
Expected<ReconstructReport> reconstruct(const ReconstructOptions& options, Progress& progress);

}  // namespace bodyscan
