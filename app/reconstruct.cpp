#include "app/reconstruct.hpp"

#include "app/interrupt.hpp"
#include "app/reconstruct_files.hpp"
#include "app/stage_clock.hpp"
#include "app/version.hpp"
#include "hal/replay/frame_reader.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/decode/decoder.hpp"
#include "pipeline/geometry/triangulate.hpp"
#include "pipeline/preview/false_color.hpp"
#include "pipeline/preview/shaded_model.hpp"
#include "pipeline/surface/simplify.hpp"
#include "pipeline/surface/surface.hpp"

#include <span>

#include <sys/resource.h>

namespace bodyscan {
namespace {

// What goes through all stages beside the data.
struct Run {
  const ReconstructOptions& options;
  const ReconstructInputs& inputs;
  ReconstructOutputs& outputs;
  Progress& progress;
  StageClock& clock;
  ReconstructReport& report;

  Expected<void> begin(const char* stage) const {
    progress.show(stage);
    return check_interrupt();
  }
};

Expected<Correspondence> decode(const Run& run) {
  const CaptureFolder& capture = run.inputs.capture;
  const auto name_folder = [&](const Error& error) { return error.within(run.options.capture.string()); };
  PatternSequence sequence{capture.manifest().projector, {}};
  for (const ManifestFrame& frame : capture.manifest().frames) sequence.patterns.push_back(frame.pattern);
  DecodeOptions options;
  options.response = capture.manifest().response;
  Expected<Decoder> decoder = Decoder::create(std::move(sequence), options).map_error(name_folder);
  if (!decoder) return tl::unexpected(decoder.error());
  int frames = 0;
  const Expected<void> read = for_each_frame(capture, [&](const Frame& frame) {
    run.progress.show("reading photograph", ++frames, capture.frame_count());
    return check_interrupt().and_then([&] { return decoder->consume(frame).map_error(name_folder); });
  });
  if (!read) return tl::unexpected(read.error());
  Expected<Correspondence> correspondence = decoder->finish().map_error(name_folder);
  run.clock.end_stage("decode");
  return correspondence;
}

struct Photographs {
  Expected<ColorImage8> white;
  Expected<ColorImage8> black;
};

Photographs load_photographs(const CaptureFolder& capture) {
  Photographs photographs;
  parallel_for(0, 2, 1, [&](int begin, int) {
    if (begin == 0) photographs.white = capture.load_white_color();
    if (begin == 1) photographs.black = capture.load_black_color();
  });
  return photographs;
}

Expected<void> write_grid(VrmlWriter& model, const GridMesh& mesh, const SurfaceColor& color) {
  const auto points = [&](std::span<const Point3f> chunk) { return model.write_points(chunk); };
  const auto colors = [&](std::span<const Rgb8> chunk) { return model.write_colors(chunk); };
  const auto faces = [&](std::span<const Face> chunk) { return model.write_faces(chunk); };
  return mesh.for_each_points(points)
      .and_then([&] { return mesh.for_each_colors(color, colors); })
      .and_then([&] { return mesh.for_each_faces(faces); });
}

Expected<void> write_simplified(VrmlWriter& model, const GridMesh& grid, const SurfaceColor& color,
                                double max_error_mm, ReconstructReport& report) {
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

void describe(const SurfaceReport& surface, ReconstructReport& report) {
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

// From photographs to a clean surface.
Expected<GridMesh> measure(const Run& run) {
  Expected<Correspondence> correspondence = decode(run);
  if (!correspondence) return tl::unexpected(correspondence.error());
  run.report.pixels_lit = correspondence->pixels_lit;
  run.report.pixels_decoded = correspondence->pixels_decoded;

  if (run.outputs.rows.wanted()) {
    const ColorImage8 picture =
        coordinate_picture(correspondence->rows->coordinate, correspondence->projector.height);
    if (Expected<void> drawn = run.outputs.rows.write_png(picture); !drawn)
      return tl::unexpected(drawn.error());
    run.clock.end_stage("rows_picture");
  }

  if (Expected<void> going_on = run.begin("triangulating"); !going_on)
    return tl::unexpected(going_on.error());
  Expected<PointGrid> points = triangulate(*correspondence, run.inputs.calibration);
  if (!points) return tl::unexpected(points.error());
  *correspondence = {};
  run.clock.end_stage("triangulate");

  if (Expected<void> going_on = run.begin("meshing"); !going_on) return tl::unexpected(going_on.error());
  SurfaceReport surface;
  Expected<GridMesh> mesh = build_surface(std::move(*points), run.inputs.calibration.camera, {}, surface);
  if (!mesh) return tl::unexpected(mesh.error());
  describe(surface, run.report);
  run.clock.end_stage("surface");
  if (mesh->face_count() == 0)
    return tl::unexpected(Error{ErrorKind::quality, run.options.capture.string() + ": " +
                                                        std::to_string(run.report.pixels_lit) +
                                                        " pixels are lit, but none of them gave a surface"});
  return mesh;
}

Expected<void> draw_surface(const Run& run, const GridMesh& mesh, const SurfaceColor& color) {
  if (run.outputs.preview.wanted()) {
    if (Expected<void> going_on = run.begin("drawing the model"); !going_on) return going_on;
    if (Expected<void> drawn = run.outputs.preview.write_png(shaded_model(mesh, &color)); !drawn)
      return drawn;
    run.clock.end_stage("preview_picture");
  }
  if (run.outputs.depth.wanted()) {
    if (Expected<void> drawn = run.outputs.depth.write_png(depth_picture(mesh)); !drawn) return drawn;
    run.clock.end_stage("depth_picture");
  }
  return {};
}

// Everything but the report.
Expected<void> save(const Run& run, const GridMesh& mesh) {
  if (Expected<void> going_on = run.begin("colouring"); !going_on) return going_on;
  const Photographs photographs = load_photographs(run.inputs.capture);
  if (!photographs.white) return tl::unexpected(photographs.white.error());
  if (!photographs.black) return tl::unexpected(photographs.black.error());
  const Expected<SurfaceColor> color = SurfaceColor::create(*photographs.white, *photographs.black);
  if (!color) return tl::unexpected(color.error());
  run.clock.end_stage("color");

  if (Expected<void> drawn = draw_surface(run, mesh, *color); !drawn) return drawn;

  if (Expected<void> going_on = run.begin("writing the model"); !going_on) return going_on;
  run.report.points = mesh.point_count();
  run.report.faces = mesh.face_count();
  run.report.mean_uncertainty_mm = mesh.mean_sigma_mm();
  VrmlWriter& model = run.outputs.model;
  Expected<void> written = run.options.max_error_mm
                               ? write_simplified(model, mesh, *color, *run.options.max_error_mm, run.report)
                               : write_grid(model, mesh, *color);
  run.clock.end_stage("write");
  return written;
}

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace

Expected<ReconstructReport> reconstruct(const ReconstructOptions& options, Progress& progress) {
  StageClock clock;
  if (Expected<void> paths = check_paths(options); !paths) return tl::unexpected(paths.error());
  const Expected<ReconstructInputs> inputs = open_inputs(options);
  if (!inputs) return tl::unexpected(inputs.error());
  ReconstructReport report;
  report.software = software_version();
  report.calibration = inputs->calibration_name;
  Expected<ReconstructOutputs> outputs =
      open_outputs(options, {report.calibration, report.software, /*comment=*/{}, /*closed=*/false});
  if (!outputs) return tl::unexpected(outputs.error());
  clock.end_stage("open");

  const Run run{options, *inputs, *outputs, progress, clock, report};
  const Expected<void> saved = measure(run).and_then([&](const GridMesh& mesh) { return save(run, mesh); });
  if (!saved) return tl::unexpected(saved.error());
  report.timings_ms = clock.stages_ms();
  report.peak_memory_bytes = peak_memory_bytes();
  const Expected<void> committed =
      outputs->report.write(to_json(report)).and_then([&] { return outputs->commit(); });
  if (!committed) return tl::unexpected(committed.error());
  return report;
}

}  // namespace bodyscan
