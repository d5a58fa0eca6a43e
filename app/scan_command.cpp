#include "app/command_line.hpp"
#include "app/console.hpp"
#include "app/interrupt.hpp"
#include "app/model_options.hpp"
#include "app/scan/scan.hpp"
#include "hal/rig/devices.hpp"
#include "pipeline/base/number_text.hpp"
#include "pipeline/calibration/calibration_file.hpp"

#include <memory>

#include <CLI/CLI.hpp>

namespace bodyscan {
namespace {

struct Arguments {
  std::filesystem::path rig;
  ScanOptions options;
  bool json = false;
};

std::string describe(const ScanReport& report, const std::filesystem::path& model) {
  const ShootingReport& shooting = report.shooting;
  std::string text = summary(report.model, model);
  text += std::to_string(shooting.shots) + " shots in " + fixed_text(shooting.total_ms / 1000, 1) +
          " s, the model " + fixed_text(report.after_last_shot_ms / 1000, 2) + " s after the last\n";
  for (const std::string& trouble : shooting.troubles) text += "overcome: " + trouble + "\n";
  for (const std::string& refused : report.refused) text += "shot again: " + refused + "\n";
  if (report.shot_again_for_motion > 0)
    text += "the patient moved: " + std::to_string(report.shot_again_for_motion) + " shots were made again\n";
  return text;
}

Expected<void> run(Arguments& arguments) {
  Expected<Rig> rig = read_rig(arguments.rig);
  if (!rig) return tl::unexpected(rig.error());
  ScanOptions& options = arguments.options;
  options.rig = std::move(*rig);
  std::vector<std::filesystem::path> inputs{arguments.rig, options.rig.calibration};
  if (Expected<void> distinct = check_distinct(options.model.paths(), inputs); !distinct) return distinct;
  const Expected<Calibration> calibration = read_calibration(options.rig.calibration);
  if (!calibration) return tl::unexpected(calibration.error().within(arguments.rig.string()));
  const Expected<std::unique_ptr<Camera>> camera = make_camera(options.rig.camera);
  if (!camera) return tl::unexpected(camera.error().within(arguments.rig.string()));
  const Expected<std::unique_ptr<Projector>> projector =
      make_projector(options.rig.projector, calibration->projector.size);
  if (!projector) return tl::unexpected(projector.error());
  const Expected<ScanReport> report = [&] {
    Progress progress;
    return scan(options, {**camera, **projector, check_interrupt}, progress);
  }();
  if (!report) return tl::unexpected(report.error());
  return print_result(arguments.json ? to_json(*report) : describe(*report, options.model.path));
}

}  // namespace

void add_scan_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      *app.add_subcommand("scan", "Scan with a projector and a camera: show, shoot, and make the model.");
  command.add_option("--rig", arguments->rig, "The station: camera, projector, calibration (TOML)")
      ->required();
  add_model_options(command, arguments->options.model);
  command.add_option("--photographs", arguments->options.photographs,
                     "Folder to keep the photographs in, for reconstruct");
  command.add_flag("--json", arguments->json, "Print the figures as one JSON object on standard output");
  command.callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace bodyscan
