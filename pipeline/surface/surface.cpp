#include "pipeline/surface/surface.hpp"

#include <utility>

namespace bodyscan {

Expected<void> SurfaceOptions::check() const {
  if (auto checked = clean.check(); !checked) return checked;
  if (auto checked = mesh.check(); !checked) return checked;
  return components.check();
}

Expected<GridMesh> build_surface(PointGrid grid, const Lens& camera, const SurfaceOptions& options,
                                 SurfaceReport& report) {
  if (auto checked = options.check(); !checked) return tl::unexpected(checked.error());
  if (grid.points.size() != camera.size || grid.sigma_mm.size() != camera.size) {
    return input_error("surface: the point grid is not of the camera's size");
  }
  report = {};
  const Image<PointState> states = find_artifacts(grid, camera, options.clean, report.clean);
  Image<std::uint8_t> cells = connect_cells(grid, states, camera, options.mesh, report.mesh);
  remove_small_components(grid, camera, options.components, cells, report.components);
  GridMesh mesh(std::move(grid), std::move(cells));
  report.loose_points = report.clean.points - report.clean.isolated_points - report.clean.flying_pixels -
                        report.components.small_component_points - mesh.point_count();
  return mesh;
}

}  // namespace bodyscan
