#include "tools/simulator/capture_folder.hpp"
#include "tools/simulator/command_options.hpp"

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace bodyscan::simulator {
namespace {

void add_motion_option(CLI::App& command, RenderOptions& options) {
  command
      .add_option_function<std::vector<double>>(
          "--motion",
          [&options](const std::vector<double>& step) {
            options.motion = {step[0], step[1], step[2]};
          },
          "mm the subject moves from frame to frame: X,Y,Z (the truth is the first frame's)")
      ->delimiter(',')
      ->expected(3);
}

void add_sequence_options(CLI::App& command, RenderOptions& options) {
  command
      .add_option_function<std::string>(
          "--axes",
          [&options](const std::string& axes) {
            options.sequence.rows = axes != "columns";
            options.sequence.columns = axes != "rows";
          },
          "stripes along rows, columns or both")
      ->check(CLI::IsMember({"rows", "columns", "both"}))
      ->default_str("rows");
  command
      .add_option_function<std::string>(
          "--patterns",
          [&options](const std::string& patterns) {
            if (patterns == "fast") options.sequence.phase = fast_sequence.phase;
          },
          "thesis (Gray code with inverses) or fast (coarse Gray code and phase steps)")
      ->check(CLI::IsMember({"thesis", "fast"}))
      ->default_str("thesis");
  command.add_flag("!--no-inverses", options.sequence.inverses, "leave the complement pictures out");
  command.add_flag("!--no-mesh", options.write_mesh, "do not write truth/mesh.obj");
}

}  // namespace

void add_render_command(CLI::App& app, Action& action) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App& command = *app.add_subcommand("render", "Render a capture folder and the truth beside it");
  add_subject_options(command, *options);
  add_motion_option(command, *options);
  command
      .add_option("--calibration", options->calibration, "FILE.yml or builtin:RIG (rows, columns, diagonal)")
      ->required();
  command.add_option("--output", options->output, "the capture folder")->required();
  add_rig_options(command, options->rig);
  add_light_options(command, *options);
  add_camera_options(command, *options);
  add_sequence_options(command, *options);
  command.footer(
      "truth/reachable.png is white where all rays of a pixel and its four neighbours meet one smooth piece "
      "of the\n"
      "surface, inside the projector's picture, directly lit, and at most 75 degrees from its normal for "
      "camera and\n"
      "projector.");
  command.callback([options, &action] {
    action = [options]() -> Expected<void> {
      const Expected<Truth> truth = render_capture(*options);
      if (!truth) return tl::unexpected(truth.error());
      return {};
    };
  });
}

}  // namespace bodyscan::simulator
