#include "tools/bench/paced_run.hpp"

#include "hal/replay/capture_folder.hpp"
#include "pipeline/calibration/calibration_file.hpp"
#include "pipeline/decode/decoder.hpp"
#include "pipeline/geometry/triangulate.hpp"
#include "pipeline/model/vrml_writer.hpp"
#include "pipeline/surface/surface.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace bodyscan {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Photographs {
  ColorImage8 white;
  ColorImage8 black;
};

// The decoder and what it needs from frame to frame.
struct Receiver {
  const CaptureFolder& capture;
  Decoder decoder;
  Photographs photographs = {};
  Frame frame = {};
  std::vector<std::byte> file = {};

  Expected<void> take(int index) {
    if (auto loaded = capture.load_into(index, frame, file); !loaded) return loaded;
    if (frame.pattern.kind == PatternKind::white) {
      auto color = capture.load_white_color();
      if (!color) return tl::unexpected(color.error());
      photographs.white = std::move(*color);
    } else if (frame.pattern.kind == PatternKind::black) {
      auto color = capture.load_black_color();
      if (!color) return tl::unexpected(color.error());
      photographs.black = std::move(*color);
    }
    return decoder.consume(frame);
  }
};

Expected<Decoder> make_decoder(const CaptureManifest& manifest) {
  PatternSequence sequence{manifest.projector, {}};
  for (const ManifestFrame& frame : manifest.frames) sequence.patterns.push_back(frame.pattern);
  DecodeOptions options;
  options.response = manifest.response;
  return Decoder::create(std::move(sequence), options);
}

// Returns when the last frame arrived.
Expected<Clock::time_point> receive_all(Receiver& receiver, double interval_s, PacedRun& run) {
  const Clock::time_point start = Clock::now();
  Clock::time_point arrival = start;
  run.frames = receiver.capture.frame_count();
  for (int i = 0; i < run.frames; ++i) {
    arrival =
        start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(i * interval_s));
    std::this_thread::sleep_until(arrival);
    const Clock::time_point begin = Clock::now();
    if (auto taken = receiver.take(i); !taken) return tl::unexpected(taken.error());
    const double taken_s = seconds_since(begin);
    run.compute_s += taken_s;
    if (i + 1 < run.frames) run.frame_s = std::max(run.frame_s, taken_s);
  }
  return arrival;
}

Expected<void> write_mesh(const GridMesh& mesh, const Photographs& photographs,
                          const std::filesystem::path& model) {
  const Expected<SurfaceColor> color = SurfaceColor::create(photographs.white, photographs.black);
  if (!color) return tl::unexpected(color.error());
  Expected<VrmlWriter> writer = VrmlWriter::create(model, VrmlGeometry::face_set, {});
  if (!writer) return tl::unexpected(writer.error());
  return mesh.for_each_points([&](std::span<const Point3f> chunk) { return writer->write_points(chunk); })
      .and_then([&] {
        return mesh.for_each_colors(*color,
                                    [&](std::span<const Rgb8> chunk) { return writer->write_colors(chunk); });
      })
      .and_then([&] {
        return mesh.for_each_faces([&](std::span<const Face> chunk) { return writer->write_faces(chunk); });
      })
      .and_then([&] { return writer->finish(); });
}

}  // namespace

Expected<PacedRun> run_paced(const std::filesystem::path& capture_dir, const std::filesystem::path& model,
                             double interval_s) {
  const Expected<Calibration> calibration = read_calibration(capture_dir / "calibration.yml");
  if (!calibration) return tl::unexpected(calibration.error());
  const Expected<CaptureFolder> capture = CaptureFolder::open(capture_dir);
  if (!capture) return tl::unexpected(capture.error());
  Expected<Decoder> decoder = make_decoder(capture->manifest());
  if (!decoder) return tl::unexpected(decoder.error());

  PacedRun run;
  Receiver receiver{*capture, std::move(*decoder)};
  const Expected<Clock::time_point> last_arrival = receive_all(receiver, interval_s, run);
  if (!last_arrival) return tl::unexpected(last_arrival.error());
  const Clock::time_point received = Clock::now();
  Expected<Correspondence> correspondence = receiver.decoder.finish();
  if (!correspondence) return tl::unexpected(correspondence.error());
  run.correspondence_s = seconds_since(*last_arrival);

  Expected<PointGrid> points = triangulate(*correspondence, *calibration);
  if (!points) return tl::unexpected(points.error());
  SurfaceReport report;
  const Expected<GridMesh> mesh = build_surface(std::move(*points), calibration->camera, {}, report);
  if (!mesh) return tl::unexpected(mesh.error());
  if (auto written = write_mesh(*mesh, receiver.photographs, model); !written) {
    return tl::unexpected(written.error());
  }
  run.model_s = seconds_since(*last_arrival);
  run.compute_s += seconds_since(received);
  return run;
}

}  // namespace bodyscan
