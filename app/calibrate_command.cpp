#include "app/calibrate_session.hpp"
#include "app/command_line.hpp"
#include "app/console.hpp"

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

namespace bodyscan {
namespace {

std::string line(const char* format, auto... values) {
  char text[256];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string summary(const CalibrationReport& report, const std::filesystem::path& output) {
  std::string text = output.string() + ": " +
                     line("camera %.3f px, projector %.3f px, together %.3f px\n", report.camera_rms_px,
                          report.projector_rms_px, report.joint_rms_px);
  if (report.leave_one_out_camera_px > 0)
    text += line("a pose left out is predicted to %.3f px in the camera and %.3f px in the projector\n",
                 report.leave_one_out_camera_px, report.leave_one_out_projector_px);
  text += line("the board's squares measure %+.3f %% off their printed side, spread %.3f %%\n",
               report.square_error_percent, report.square_spread_percent);
  for (const PoseReport& pose : report.poses)
    if (!pose.used || !pose.reason.empty())
      text += pose.name + (pose.used ? ": " : " left out: ") + pose.reason + "\n";
  for (const std::string& advice : report.advice) text += advice + "\n";
  return text;
}

Expected<void> run(const CalibrateOptions& options, bool json) {
  const Expected<CalibrateOutcome> outcome = [&] {
    Progress progress;
    return calibrate_session(options, progress);
  }();
  if (!outcome) return tl::unexpected(outcome.error());
  const auto& [calibration, report] = outcome->result;
  return print_result(json ? to_json(report, calibration, outcome->run) : summary(report, options.output));
}

}  // namespace

void add_calibrate_command(CLI::App& app, Action& action) {
  struct Arguments {
    CalibrateOptions options;
    bool json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  CalibrateOptions& options = arguments->options;
  CLI::App& command =
      *app.add_subcommand("calibrate", "Calibrate camera and projector from pictures of a printed board.");
  command.add_option("SESSION_DIR", options.session, "Folder with session.json and its pictures")->required();
  command.add_option("--output", options.output, "Calibration file to write (YAML)")->required();
  command.add_option("--report", options.report, "Write figures, poses and parameters as JSON");
  command.add_option("--plots", options.plots,
                     "Folder to draw residuals, coverage, poses and a histogram into (SVG)");
  command.add_option("--keep-intrinsics", options.keep_intrinsics,
                     "A calibration whose lenses still hold: one pose is enough to find where the projector "
                     "stands now");
  command.add_flag("--json", arguments->json, "Print the report as one JSON object on standard output");
  command.callback(
      [arguments, &action] { action = [arguments] { return run(arguments->options, arguments->json); }; });
}

}  // namespace bodyscan
