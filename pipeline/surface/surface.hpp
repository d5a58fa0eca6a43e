#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/surface/cells.hpp"
#include "pipeline/surface/clean.hpp"
#include "pipeline/surface/components.hpp"
#include "pipeline/surface/grid_mesh.hpp"

namespace bodyscan {

struct SurfaceOptions {
  CleanOptions clean;
  MeshOptions mesh;
  ComponentOptions components;

  [[nodiscard]] Expected<void> check() const;
};

struct SurfaceReport {
  CleanReport clean;
  MeshReport mesh;
  ComponentReport components;
  std::size_t loose_points = 0;  // kept by cleaning, but in no triangle

  // All points that were measured and are not in the mesh.
  [[nodiscard]] std::size_t artifacts_removed() const {
    return clean.isolated_points + clean.flying_pixels + components.small_component_points + loose_points;
  }
};

// From measured points to a surface: artifacts away, neighbours joined, small pieces away. The grid moves
// into the mesh. Error: an option out of its range, or a grid that is not of the camera's size.
[[nodiscard]] Expected<GridMesh> build_surface(PointGrid grid, const Lens& camera,
                                               const SurfaceOptions& options, SurfaceReport& report);

}  // namespace bodyscan
