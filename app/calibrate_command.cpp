#include "app/calibrate_session.hpp"
#include "app/command_line.hpp"
#include "app/console.hpp"
#include "pipeline/base/number_text.hpp"

#include <memory>

#include <CLI/CLI.hpp>

namespace bodyscan {
namespace {

std::string px(double value) {
  return fixed_text(value, 3) + " px";
}

std::string percent(double value) {
  return (value > 0 ? "+" : "") + fixed_text(value, 3) + " %";
}

std::string summary(const CalibrationReport& report, const std::filesystem::path& output) {
  std::string text = output.string() + ": camera " + px(report.camera_rms_px) + ", projector " +
                     px(report.projector_rms_px) + ", together " + px(report.joint_rms_px) + " (" +
                     std::to_string(report.corners_left_out) + " of " + std::to_string(report.corners) +
                     " corners left out)\n";
  if (report.leave_one_out_camera_px && report.leave_one_out_projector_px)
    text += "a pose that is left out: " + px(*report.leave_one_out_camera_px) + " in the camera, " +
            px(*report.leave_one_out_projector_px) + " in the projector\n";
  if (report.square_error_percent && report.square_spread_percent)
    text += "the board's squares come out " + percent(*report.square_error_percent) +
            " off their printed side, spread " + fixed_text(*report.square_spread_percent, 3) + " %\n";
  for (const PoseReport& pose : report.poses) {
    if (!pose.used) text += pose.name + " left out: " + pose.reason + "\n";
    for (const std::string& note : pose.notes) text += pose.name + ": " + note + "\n";
  }
  for (const std::string& advice : report.advice) text += advice + "\n";
  if (report.relative_uncertainty)
    text += "focal lengths and baseline are known to " + fixed_text(100 * *report.relative_uncertainty, 3) +
            " %: " + report.verdict + "\n";
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
