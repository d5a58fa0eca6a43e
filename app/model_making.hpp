#pragma once

#include "app/console.hpp"
#include "app/model_files.hpp"
#include "app/model_report.hpp"
#include "app/named_calibration.hpp"
#include "app/stage_clock.hpp"
#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"
#include "pipeline/decode/correspondence.hpp"
#include "pipeline/geometry/point_grid.hpp"
#include "pipeline/surface/grid_mesh.hpp"

#include <string>

namespace bodyscan {

// From decoded photographs to a saved model: what goes through all stages beside the data.
struct ModelMaking {
  const ModelOptions& options;
  const NamedCalibration& calibration;
  std::string source;  // of the photographs; stands in front of messages
  ModelFiles& files;
  Progress& progress;
  StageClock& clock;
  ModelReport& report;

  // Shows the stage; an error where the program was interrupted.
  [[nodiscard]] Expected<void> begin(const char* stage) const;
};

// Draws the rows where that is asked for.
Expected<void> draw_rows(const ModelMaking& run, const Correspondence& correspondence);

Expected<PointGrid> make_points(const ModelMaking& run, const Correspondence& correspondence);

// Meshes and cleans. Quality error: lit pixels give no surface at all.
Expected<GridMesh> make_surface(const ModelMaking& run, PointGrid points);

struct WhiteAndBlack {
  ColorImage8 white;
  ColorImage8 black;
};

// Colours the surface and writes everything but the report.
Expected<void> save_model(const ModelMaking& run, const GridMesh& mesh, const WhiteAndBlack& photographs);

// Adds times and memory to the report.
void finish_report(const ModelMaking& run);

// The files appear under their names.
Expected<void> commit_model(const ModelMaking& run, const std::string& report);

}  // namespace bodyscan
