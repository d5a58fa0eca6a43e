#include "app/calibrate_session.hpp"

#include "app/calibration_report_json.hpp"
#include "app/output_files.hpp"
#include "app/session_poses.hpp"
#include "app/stage_clock.hpp"
#include "app/version.hpp"
#include "pipeline/base/size_text.hpp"
#include "pipeline/calibration/calibration_file.hpp"
#include "pipeline/calibration/plots.hpp"

#include <array>
#include <chrono>
#include <ctime>
#include <system_error>

namespace bodyscan {
namespace {

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

Expected<void> check_paths(const CalibrateOptions& options) {
  std::vector<std::filesystem::path> outputs{options.output};
  if (options.report) outputs.push_back(*options.report);
  std::vector<std::filesystem::path> inputs{options.session / "session.json"};
  return check_distinct(outputs, inputs);
}

Expected<std::optional<Calibration>> known_intrinsics(const CalibrateOptions& options,
                                                      const CalibrationSession& session) {
  if (!options.keep_intrinsics) return std::nullopt;
  const Expected<Calibration> known = read_calibration(*options.keep_intrinsics);
  if (!known) return tl::unexpected(known.error());
  const auto check = [&](const char* key, Size calibrated, const char* what, Size now) -> Expected<void> {
    if (calibrated == now) return {};
    return input_error(options.keep_intrinsics->string() + ": " + key + ": " + text_of(calibrated) +
                       ", but the " + what + " of " + options.session.string() + " has " + text_of(now));
  };
  const Expected<void> fits =
      check("camera_size", known->camera.size, "camera", session.size()).and_then([&] {
        return check("projector_size", known->projector.size, "projector", session.manifest().projector);
      });
  if (!fits) return tl::unexpected(fits.error());
  return *known;
}

Expected<void> write_plots(const std::filesystem::path& folder, const CalibrationResult& result,
                           const PrintedBoard& board) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) return output_error(folder.string() + ": " + code.message());
  for (const Plot& plot : calibration_plots(result.report, result.calibration, board)) {
    Expected<AtomicFile> file = AtomicFile::create(folder / plot.file_name);
    if (!file) return tl::unexpected(file.error());
    const Expected<void> written =
        file->write(plot.svg).and_then([&] { return file->commit(Durability::process); });
    if (!written) return written;
  }
  return {};
}

CalibrationNotes notes_of(const CalibrationReport& report) {
  return {utc_now(), report.camera_rms_px, report.projector_rms_px, report.joint_rms_px};
}

}  // namespace

Expected<CalibrateOutcome> calibrate_session(const CalibrateOptions& options, Progress& progress) {
  StageClock clock;
  if (Expected<void> paths = check_paths(options); !paths) return tl::unexpected(paths.error());
  const Expected<CalibrationSession> session = CalibrationSession::open(options.session);
  if (!session) return tl::unexpected(session.error());
  const auto known = known_intrinsics(options, *session);
  if (!known) return tl::unexpected(known.error());
  Expected<OptionalOutput> report = OptionalOutput::create(options.report);
  if (!report) return tl::unexpected(report.error());
  clock.end_stage("open");

  const auto in_session = [&](const Error& error) { return error.within(options.session.string()); };
  auto poses = look_at_poses(*session, progress).map_error(in_session);
  if (!poses) return tl::unexpected(poses.error());
  clock.end_stage("find_boards");

  progress.show("calibrating");
  const SessionManifest& manifest = session->manifest();
  auto result = calibrate({manifest.board, session->size(), manifest.projector, std::move(*poses), *known})
                    .map_error(in_session);
  if (!result) return tl::unexpected(result.error());
  clock.end_stage("calibrate");

  if (options.plots) {
    if (Expected<void> drawn = write_plots(*options.plots, *result, manifest.board); !drawn)
      return tl::unexpected(drawn.error());
    clock.end_stage("plots");
  }
  const Expected<void> written =
      report->write(to_json(result->report, result->calibration, std::string(software_version())))
          .and_then([&] {
            return write_calibration(result->calibration, options.output, notes_of(result->report));
          })
          .and_then([&] { return report->commit(); });
  if (!written) return tl::unexpected(written.error());
  return CalibrateOutcome{std::move(*result), clock.stages_ms()};
}

}  // namespace bodyscan
