#pragma once

#include "app/output_files.hpp"
#include "pipeline/base/error.hpp"
#include "pipeline/model/vrml_writer.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace bodyscan {

// What is made of a measured surface.
struct ModelOptions {
  std::filesystem::path path;          // VRML
  OptionalPath report;                 // JSON
  OptionalPath preview;                // PNG: the shaded model
  OptionalPath depth;                  // PNG: depth in false colour
  OptionalPath rows;                   // PNG: projector rows in false colour
  std::optional<double> max_error_mm;  // simplify the surface by at most this; else keep every point

  [[nodiscard]] std::vector<std::filesystem::path> paths() const;
};

// The files, opened. Nothing appears under its name before `commit`.
struct ModelFiles {
  VrmlWriter model;
  OptionalOutput report;
  OptionalOutput preview;
  OptionalOutput depth;
  OptionalOutput rows;

  // Error: a file that cannot be written.
  static Expected<ModelFiles> open(const ModelOptions& options, const ModelInfo& info);
  Expected<void> commit();
};

}  // namespace bodyscan
