#include "app/model_making.hpp"

#include "app/interrupt.hpp"
#include "pipeline/geometry/triangulate.hpp"
#include "pipeline/preview/false_color.hpp"
#include "pipeline/preview/shaded_model.hpp"
#include "pipeline/surface/simplify.hpp"
#include "pipeline/surface/surface.hpp"

#include <span>

#include <sys/resource.h>

namespace bodyscan {
namespace {

Expected<void> write_grid(VrmlWriter& model, const GridMesh& mesh, const SurfaceColor& color) {
  const auto points = [&](std::span<const Point3f> chunk) { return model.write_points(chunk); };
  const auto colors = [&](std::span<const Rgb8> chunk) { return model.write_colors(chunk); };
  const auto faces = [&](std::span<const Face> chunk) { return model.write_faces(chunk); };
  return mesh.for_each_points(points)
      .and_then([&] { return mesh.for_each_colors(color, colors); })
      .and_then([&] { return mesh.for_each_faces(faces); });
}

Expected<void> write_simplified(VrmlWriter& model, const GridMesh& grid, const SurfaceColor& color,
                                double max_error_mm, ModelReport& report) {
  SimplifyOptions options;
  options.max_error_mm = max_error_mm;
  const Expected<Mesh> mesh = simplify(grid, &color, options);
  if (!mesh) return tl::unexpected(mesh.error());
  report.points = mesh->points.size();
  report.faces = mesh->faces.size();
  return model.write_points(mesh->points)
      .and_then([&] { return model.write_colors(mesh->colors); })
      .and_then([&] { return model.write_faces(mesh->faces); });
}

void describe(const SurfaceReport& surface, ModelReport& report) {
  report.artifacts_removed = {
      {"isolated_points", surface.clean.isolated_points},
      {"flying_pixels", surface.clean.flying_pixels},
      {"edges_cut", surface.mesh.edges_cut},
      {"faces_too_large", surface.mesh.faces_removed_by_area},
      {"small_components", surface.components.small_components},
      {"small_component_points", surface.components.small_component_points},
      {"loose_points", surface.loose_points},
  };
}

Expected<void> draw_surface(const ModelMaking& run, const GridMesh& mesh, const SurfaceColor& color) {
  if (run.files.preview.wanted()) {
    if (Expected<void> going_on = run.begin("drawing the model"); !going_on) return going_on;
    if (Expected<void> drawn = run.files.preview.write_png(shaded_model(mesh, &color)); !drawn) return drawn;
    run.clock.end_stage("preview_picture");
  }
  if (run.files.depth.wanted()) {
    if (Expected<void> drawn = run.files.depth.write_png(depth_picture(mesh)); !drawn) return drawn;
    run.clock.end_stage("depth_picture");
  }
  return {};
}

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace

Expected<void> ModelMaking::begin(const char* stage) const {
  progress.show(stage);
  return check_interrupt();
}

Expected<void> draw_rows(const ModelMaking& run, const Correspondence& correspondence) {
  if (!run.files.rows.wanted()) return {};
  Expected<void> drawn = run.files.rows.write_png(
      coordinate_picture(correspondence.rows->coordinate, correspondence.projector.height));
  run.clock.end_stage("rows_picture");
  return drawn;
}

Expected<PointGrid> make_points(const ModelMaking& run, const Correspondence& correspondence) {
  run.report.pixels_lit = correspondence.pixels_lit;
  run.report.pixels_decoded = correspondence.pixels_decoded;
  if (Expected<void> going_on = run.begin("triangulating"); !going_on)
    return tl::unexpected(going_on.error());
  Expected<PointGrid> points = triangulate(correspondence, run.calibration.calibration);
  run.clock.end_stage("triangulate");
  return points;
}

Expected<GridMesh> make_surface(const ModelMaking& run, PointGrid points) {
  if (Expected<void> going_on = run.begin("meshing"); !going_on) return tl::unexpected(going_on.error());
  SurfaceReport surface;
  Expected<GridMesh> mesh = build_surface(std::move(points), run.calibration.calibration.camera, {}, surface);
  if (!mesh) return tl::unexpected(mesh.error());
  describe(surface, run.report);
  run.clock.end_stage("surface");
  if (mesh->face_count() == 0)
    return tl::unexpected(Error{ErrorKind::quality, run.source + ": " +
                                                        std::to_string(run.report.pixels_lit) +
                                                        " pixels are lit, but none of them gave a surface"});
  return mesh;
}

Expected<void> save_model(const ModelMaking& run, const GridMesh& mesh, const WhiteAndBlack& photographs) {
  const Expected<SurfaceColor> color = SurfaceColor::create(photographs.white, photographs.black);
  if (!color) return tl::unexpected(color.error());
  run.clock.end_stage("color");

  if (Expected<void> drawn = draw_surface(run, mesh, *color); !drawn) return drawn;

  if (Expected<void> going_on = run.begin("writing the model"); !going_on) return going_on;
  run.report.points = mesh.point_count();
  run.report.faces = mesh.face_count();
  run.report.mean_uncertainty_mm = mesh.mean_sigma_mm();
  VrmlWriter& model = run.files.model;
  Expected<void> written = run.options.max_error_mm
                               ? write_simplified(model, mesh, *color, *run.options.max_error_mm, run.report)
                               : write_grid(model, mesh, *color);
  run.clock.end_stage("write");
  return written;
}

Expected<void> commit_model(const ModelMaking& run, const std::string& report) {
  return run.files.report.write(report).and_then([&] { return run.files.commit(); });
}

void finish_report(const ModelMaking& run) {
  run.report.timings_ms = run.clock.stages_ms();
  run.report.peak_memory_bytes = peak_memory_bytes();
}

}  // namespace bodyscan
