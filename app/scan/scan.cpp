#include "app/scan/scan.hpp"

#include "app/model_making.hpp"
#include "app/scan/kept_photographs.hpp"
#include "app/scan/light_guard.hpp"
#include "app/scan/live_decoder.hpp"
#include "app/version.hpp"
#include "hal/clock.hpp"
#include "pipeline/base/number_text.hpp"
#include "pipeline/image/codec.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace bodyscan {
namespace {

constexpr int depth_step = 8;  // px between the points that the subject's distance is taken from

Expected<PatternSequence> sequence_of(const Rig& rig, Size projector) {
  if (rig.scan.patterns == PatternChoice::fast) return make_sequence(projector, fast_sequence);
  SequenceOptions options;
  options.rows = rig.scan.patterns != PatternChoice::columns;
  options.columns = rig.scan.patterns != PatternChoice::rows;
  return make_sequence(projector, options);
}

// Median distance of the points, mm; 0 without any.
double distance_mm(const PointGrid& grid) {
  std::vector<float> depths;
  for (int y = 0; y < grid.points.height(); y += depth_step)
    for (int x = 0; x < grid.points.width(); x += depth_step)
      if (grid.has(x, y)) depths.push_back(grid.points(x, y).z);
  if (depths.empty()) return 0;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

// What goes through all of a scan.
struct Session {
  const ScanOptions& options;
  const ModelMaking& making;
  LightGuard& light;
  Shooting& shooting;
  LiveDecoder& decoder;
  ScanReport& report;
  std::int64_t last_shot_us = 0;

  Expected<DecodedShots> shoot(const std::vector<int>& wanted);
};

// The photographs of these patterns, and what all of them together show.
Expected<DecodedShots> Session::shoot(const std::vector<int>& wanted) {
  ShotList list(wanted, decoder.pattern_count(), options.rig.scan.attempts);
  decoder.begin(list, wanted);
  const int planned = report.shooting.shots + static_cast<int>(wanted.size());
  const Expected<void> shot = shooting.shoot(
      list, decoder, [&](int shots) { making.progress.show("shooting", std::min(shots, planned), planned); });
  last_shot_us = monotonic_us();
  Expected<void> dark = light.darken();
  making.clock.end_stage("shoot");
  const Expected<void> all_there = shot.and_then([&] { return dark; });
  if (!all_there) decoder.abandon();
  Expected<DecodedShots> decoded =
      all_there ? decoder.finish() : Expected<DecodedShots>(tl::unexpected(all_there.error()));
  making.clock.end_stage("decode");
  report.shooting = shooting.report();
  for (std::string& refusal : list.refusals()) report.refused.push_back(std::move(refusal));
  return decoded;
}

struct Measured {
  Correspondence correspondence;
  PointGrid points;
};

Expected<Measured> measure(Session& session, const std::vector<int>& wanted) {
  Expected<DecodedShots> decoded = session.shoot(wanted);
  if (!decoded) return tl::unexpected(decoded.error());
  Expected<PointGrid> points = make_points(session.making, decoded->correspondence);
  if (!points) return tl::unexpected(points.error());
  const double mm_per_px = distance_mm(*points) / session.making.calibration.calibration.camera.fx;
  session.report.motion = decoded->motion;
  session.report.motion_mm = decoded->motion.largest_px * mm_per_px;
  return Measured{std::move(decoded->correspondence), std::move(*points)};
}

// Patterns that were shot before the subject came to where the last white shows it, and that white.
std::vector<int> outdated_patterns(const Session& session) {
  const SequenceMotion& motion = session.report.motion;
  const int last = session.decoder.pattern_count() - 1;
  const double limit_px =
      motion.largest_px * session.options.rig.scan.max_motion_mm / session.report.motion_mm;
  std::vector<int> wanted;
  for (int pattern = 0; pattern < last; ++pattern)
    if (motion.by_pattern_px.empty() || motion.by_pattern_px[static_cast<std::size_t>(pattern)] > limit_px)
      wanted.push_back(pattern);
  wanted.push_back(last);
  return wanted;
}

Expected<Measured> measure_at_rest(Session& session) {
  std::vector<int> all(static_cast<std::size_t>(session.decoder.pattern_count()));
  std::iota(all.begin(), all.end(), 0);
  Expected<Measured> measured = measure(session, all);
  const double limit_mm = session.options.rig.scan.max_motion_mm;
  if (!measured || session.report.motion_mm <= limit_mm) return measured;
  const std::vector<int> wanted = outdated_patterns(session);
  session.report.shot_again_for_motion = static_cast<int>(wanted.size());
  measured = measure(session, wanted);
  if (!measured || session.report.motion_mm <= limit_mm) return measured;
  const Eigen::Vector2d& at = session.report.motion.at;
  return tl::unexpected(
      Error{ErrorKind::quality, "the patient moved by " + fixed_text(session.report.motion_mm, 1) +
                                    " mm during the scan, most at pixel " + fixed_text(at.x(), 0) + ", " +
                                    fixed_text(at.y(), 0) + " of the picture (" + fixed_text(limit_mm, 1) +
                                    " mm are allowed): scan again, holding still"});
}

Expected<WhiteAndBlack> white_and_black(const LiveDecoder& decoder) {
  Expected<ColorImage8> white = decode_color(decoder.photograph(0).file);
  Expected<ColorImage8> black = decode_color(decoder.photograph(1).file);
  if (!white) return tl::unexpected(white.error());
  if (!black) return tl::unexpected(black.error());
  return WhiteAndBlack{std::move(*white), std::move(*black)};
}

Expected<void> make_model(Session& session) {
  if (Expected<void> opened = session.shooting.open(); !opened) return opened;
  session.report.camera = session.shooting.identity();
  session.report.settings = session.shooting.settings();
  session.making.clock.end_stage("open_devices");
  Expected<Measured> measured = measure_at_rest(session);
  session.report.light_s = session.light.light_s();
  if (!measured) return tl::unexpected(measured.error());
  if (Expected<void> drawn = draw_rows(session.making, measured->correspondence); !drawn) return drawn;
  measured->correspondence = {};
  const Expected<GridMesh> mesh = make_surface(session.making, std::move(measured->points));
  if (!mesh) return tl::unexpected(mesh.error());
  const Expected<WhiteAndBlack> photographs = white_and_black(session.decoder);
  if (!photographs) return tl::unexpected(photographs.error());
  return save_model(session.making, *mesh, *photographs);
}

}  // namespace

Expected<ScanReport> scan(const ScanOptions& options, const Station& station, Progress& progress) {
  StageClock clock;
  const Expected<NamedCalibration> calibration = read_named_calibration(options.rig.calibration);
  if (!calibration) return tl::unexpected(calibration.error());
  const Calibration& devices = calibration->calibration;
  const Expected<PatternSequence> sequence = sequence_of(options.rig, devices.projector.size);
  if (!sequence) return tl::unexpected(sequence.error());
  ScanReport report;
  report.model.software = software_version();
  report.model.calibration = calibration->name;
  Expected<ModelFiles> files = ModelFiles::open(
      options.model, {report.model.calibration, report.model.software, /*comment=*/{}, /*closed=*/false});
  if (!files) return tl::unexpected(files.error());
  clock.end_stage("open_files");

  const ModelMaking making{options.model, *calibration, "the scan", *files, progress, clock, report.model};
  LightGuard light(station.projector, options.rig.scan.max_light_s, station.stop);
  Shooting shooting(station.camera, light, options.rig, *sequence, station.patience);
  LiveDecoder decoder(*sequence, devices.camera.size, {});
  Session session{options, making, light, shooting, decoder, report};
  const Expected<void> made = make_model(session);
  station.camera.close();
  if (!made && made.error().kind != ErrorKind::quality) return tl::unexpected(made.error());
  finish_report(making);
  if (options.photographs && decoder.complete()) {
    const Expected<void> kept =
        keep_photographs(*options.photographs, *sequence, decoder, report.camera, report.settings);
    if (!kept) return tl::unexpected(kept.error());
  }
  report.after_last_shot_ms = static_cast<double>(monotonic_us() - session.last_shot_us) * 1e-3;
  if (!made) {
    const Expected<void> told =
        files->report.write(to_json(report)).and_then([&] { return files->report.commit(); });
    return tl::unexpected(told ? made.error() : told.error());
  }
  if (const Expected<void> committed = commit_model(making, to_json(report)); !committed)
    return tl::unexpected(committed.error());
  return report;
}

}  // namespace bodyscan
