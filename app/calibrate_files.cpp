#include "app/calibrate_files.hpp"

#include "app/calibration_fit.hpp"
#include "pipeline/calibration/calibration_file.hpp"
#include "pipeline/drawing/plots.hpp"

#include <array>
#include <chrono>
#include <ctime>
#include <span>
#include <string_view>

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

// The calibration first.
std::vector<std::filesystem::path> outputs_of(const CalibrateOptions& options) {
  std::vector<std::filesystem::path> outputs{options.output};
  if (options.report) outputs.push_back(*options.report);
  if (options.plots)
    for (const std::string_view name : plot_file_names) outputs.push_back(*options.plots / name);
  return outputs;
}

Expected<std::optional<KeptCalibration>> kept_calibration(const CalibrateOptions& options,
                                                          const CalibrationSession& session) {
  if (!options.keep_intrinsics) return std::nullopt;
  const Expected<Calibration> known = read_calibration(*options.keep_intrinsics);
  if (!known) return tl::unexpected(known.error());
  const Expected<CalibrationNotes> notes = read_calibration_notes(*options.keep_intrinsics);
  if (!notes) return tl::unexpected(notes.error());
  const Expected<void> fits = check_fit(*known, *options.keep_intrinsics,
                                        {options.session, session.size(), session.manifest().projector});
  if (!fits) return tl::unexpected(fits.error());
  return KeptCalibration{*known, notes->camera_rms_px.value_or(0), notes->projector_rms_px.value_or(0)};
}

}  // namespace

Expected<CalibrateInputs> open_inputs(const CalibrateOptions& options) {
  const std::vector<std::filesystem::path> outputs = outputs_of(options);
  if (Expected<void> distinct = check_distinct(outputs, std::array{options.session / "session.json"});
      !distinct)
    return tl::unexpected(distinct.error());
  Expected<CalibrationSession> session = CalibrationSession::open(options.session);
  if (!session) return tl::unexpected(session.error());
  if (Expected<void> distinct = check_distinct(outputs, session->files()); !distinct)
    return tl::unexpected(distinct.error());
  if (options.keep_intrinsics)
    if (Expected<void> distinct =
            check_distinct(std::span(outputs).subspan(1), std::array{*options.keep_intrinsics});
        !distinct)
      return tl::unexpected(distinct.error());
  const auto kept = kept_calibration(options, *session);
  if (!kept) return tl::unexpected(kept.error());
  return CalibrateInputs{std::move(*session), *kept};
}

Expected<CalibrateOutputs> CalibrateOutputs::open(const CalibrateOptions& options) {
  Expected<AtomicFile> calibration = AtomicFile::create(options.output);
  if (!calibration) return tl::unexpected(calibration.error());
  Expected<OptionalOutput> report = OptionalOutput::create(options.report);
  if (!report) return tl::unexpected(report.error());
  CalibrateOutputs outputs(std::move(*calibration));
  outputs.report_ = std::move(*report);
  if (options.plots)
    if (Expected<void> opened = outputs.open_plots(*options.plots); !opened)
      return tl::unexpected(opened.error());
  return outputs;
}

Expected<void> CalibrateOutputs::open_plots(const std::filesystem::path& folder) {
  Expected<OutputFolder> made = OutputFolder::create(folder);
  if (!made) return tl::unexpected(made.error());
  plots_folder_.emplace(std::move(*made));
  for (const std::string_view name : plot_file_names) {
    Expected<AtomicFile> file = AtomicFile::create(folder / name);
    if (!file) return tl::unexpected(file.error());
    plots_.push_back(std::move(*file));
  }
  return {};
}

Expected<void> CalibrateOutputs::draw_plots(const CalibrationResult& result, const PrintedBoard& board) {
  if (plots_.empty()) return {};
  const std::vector<Plot> plots = calibration_plots(result.report, result.calibration, board);
  for (std::size_t i = 0; i < plots.size(); ++i)
    if (Expected<void> written = plots_[i].write(plots[i].svg); !written) return written;
  return {};
}

Expected<void> CalibrateOutputs::write(const CalibrateOutcome& outcome, const CalibrateInputs& inputs) {
  const Calibration& calibration = outcome.result.calibration;
  const CalibrationReport& report = outcome.result.report;
  CalibrationNotes notes{utc_now(), report.camera_rms_px, report.projector_rms_px, report.joint_rms_px};
  if (const auto& kept = inputs.kept) {
    if (kept->camera_rms_px > 0) notes.camera_rms_px = kept->camera_rms_px;
    if (kept->projector_rms_px > 0) notes.projector_rms_px = kept->projector_rms_px;
  }
  return calibration_text(calibration, notes)
      .and_then([&](const std::string& text) { return calibration_.write(text); })
      .and_then([&] { return report_.write(to_json(report, calibration, outcome.run)); })
      .and_then([&] { return draw_plots(outcome.result, inputs.session.manifest().board); });
}

Expected<void> CalibrateOutputs::commit() {
  for (AtomicFile& plot : plots_)
    if (Expected<void> committed = plot.commit(Durability::process); !committed) return committed;
  return report_.commit().and_then([&] { return calibration_.commit(Durability::power_cut); });
}

}  // namespace bodyscan
