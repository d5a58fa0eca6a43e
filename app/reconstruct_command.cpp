#include "app/command_line.hpp"
#include "app/console.hpp"
#include "app/model_options.hpp"
#include "app/reconstruct.hpp"

#include <memory>

#include <CLI/CLI.hpp>

namespace bodyscan {
namespace {

Expected<void> run(const ReconstructOptions& options, bool json) {
  Expected<ModelReport> report = [&] {
    Progress progress;
    return reconstruct(options, progress);
  }();
  if (!report) return tl::unexpected(report.error());
  return print_result(json ? to_json(*report) : summary(*report, options.model.path));
}

}  // namespace

void add_reconstruct_command(CLI::App& app, Action& action) {
  struct Arguments {
    ReconstructOptions options;
    bool json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  ReconstructOptions& options = arguments->options;
  CLI::App& command = *app.add_subcommand(
      "reconstruct", "Make a coloured 3D model (VRML97) of the photographs in a capture folder.");
  command.add_option("CAPTURE_DIR", options.capture, "Folder with capture.json and its photographs")
      ->required();
  command.add_option("--calibration", options.calibration, "Calibration of camera and projector (YAML)")
      ->required();
  add_model_options(command, options.model);
  command.add_flag("--json", arguments->json, "Print the figures as one JSON object on standard output");
  command.callback(
      [arguments, &action] { action = [arguments] { return run(arguments->options, arguments->json); }; });
}

}  // namespace bodyscan
