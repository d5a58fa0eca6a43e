#include "app/model_options.hpp"

#include <CLI/CLI.hpp>

namespace bodyscan {

void add_model_options(CLI::App& command, ModelOptions& options) {
  command.add_option("--output", options.path, "Model to write")->required();
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
}

std::string summary(const ModelReport& report, const std::filesystem::path& model) {
  return model.string() + ": " + std::to_string(report.points) + " points, " + std::to_string(report.faces) +
         " faces\n";
}

}  // namespace bodyscan
