#include "app/command_line.hpp"
#include "app/console.hpp"
#include "app/reconstruct.hpp"

#include <memory>

#include <CLI/CLI.hpp>

namespace bodyscan {
namespace {

std::string summary(const ReconstructReport& report, const std::filesystem::path& model) {
  return model.string() + ": " + std::to_string(report.points) + " points, " + std::to_string(report.faces) +
         " faces\n";
}

Expected<void> run(const ReconstructOptions& options, bool json) {
  Expected<ReconstructReport> report = [&] {
    Progress progress;
    return reconstruct(options, progress);
  }();
  if (!report) return tl::unexpected(report.error());
  return print_result(json ? to_json(*report) : summary(*report, options.model));
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
  command.add_option("--output", options.model, "Model to write")->required();
  command.add_option("--report", options.report, "Write the figures of the reconstruction as JSON");
  command.add_option("--preview", options.preview, "Write a picture of the shaded model (PNG)");
  command.add_option("--depth", options.depth, "Write the depth in false colour (PNG)");
  command.add_option("--rows", options.rows,
                     "Write the projector row seen by each pixel in false colour (PNG)");
  const CLI::Validator length(
      [](const std::string& text) {
        double mm = 0;
        const bool valid = CLI::detail::lexical_cast(text, mm) && mm >= 1e-4 && mm <= 1000;
        return valid ? std::string() : "must be 0.0001 to 1000 mm";
      },
      "MM");
  command
      .add_option("--max-error", options.max_error_mm,
                  "Simplify the surface: no measured point moves by more than this (mm)")
      ->check(length);
  command.add_flag("--json", arguments->json, "Print the figures as one JSON object on standard output");
  command.callback(
      [arguments, &action] { action = [arguments] { return run(arguments->options, arguments->json); }; });
}

}  // namespace bodyscan
