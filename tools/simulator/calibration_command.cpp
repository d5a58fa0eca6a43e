#include "tools/simulator/command_options.hpp"
#include "tools/simulator/session_folder.hpp"

#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace bodyscan::simulator {
namespace {

struct Arguments {
  SessionOptions options;
  std::vector<std::string> blunders;  // POSE:KIND
};

void add_board_options(CLI::App& command, SessionOptions& options) {
  command.add_option("--columns", options.board.columns, "inner corners of the printed board")
      ->capture_default_str();
  command.add_option("--rows", options.board.rows, "inner corners of the printed board")
      ->capture_default_str();
  command.add_option("--square-mm", options.board.square_mm, "side of the printed board's squares")
      ->capture_default_str();
  command
      .add_option(
          "--bend", options.bend_mm,
          "mm that the sheet's left and right edges go back behind its middle; negative: come forward")
      ->capture_default_str();
  command
      .add_option(
          "--plate", options.plate_mm,
          "mm of white plate beyond the sheet, for the projected board to fall on; projected poses only")
      ->capture_default_str();
  command
      .add_option("--projected-share", options.projected_share,
                  "of the projector's picture's sides that the projected board's squares span; less where "
                  "the camera would "
                  "not see all of them")
      ->capture_default_str();
}

void add_pose_options(CLI::App& command, Arguments& arguments) {
  const std::map<std::string, SessionMethod> methods{{"gray", SessionMethod::gray},
                                                     {"projected", SessionMethod::projected},
                                                     {"mixed", SessionMethod::mixed}};
  command
      .add_option_function<std::string>(
          "--method",
          [methods, &arguments](const std::string& name) { arguments.options.method = methods.at(name); },
          "gray (a Gray-code capture a pose), projected (a pair of pictures a pose) or mixed (by turns)")
      ->check(CLI::IsMember(methods))
      ->default_str("mixed");
  command.add_option("--poses", arguments.options.poses, "how often the board is shot, up to 14 times")
      ->capture_default_str();
  command
      .add_option(
          "--blunder", arguments.blunders,
          "POSE:KIND, a pose (from 0) that goes wrong: cut (partly outside the picture), moved (by 4 mm and "
          "1 degree after the first picture), blurred (5 px more), size (a column less), scaled (4 % larger "
          "squares), dark (2 % of the light after the first picture), overexposed (6 times the light)")
      ->delimiter(',');
}

Expected<void> run(const Arguments& arguments) {
  SessionOptions options = arguments.options;
  for (const std::string& text : arguments.blunders) {
    const Expected<PlantedBlunder> blunder = parse_blunder(text);
    if (!blunder) return tl::unexpected(blunder.error());
    options.blunders.push_back(*blunder);
  }
  const Expected<SessionTruth> truth = render_session(options);
  if (!truth) return tl::unexpected(truth.error());
  return {};
}

}  // namespace

void add_calibration_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<Arguments>();
  RenderOptions& render = arguments->options.render;
  CLI::App& command =
      *app.add_subcommand("calibration", "Render a calibration session folder and the truth beside it");
  command
      .add_option("--calibration", render.calibration,
                  "the rig to find: FILE.yml or builtin:RIG (rows, columns, diagonal)")
      ->capture_default_str();
  command.add_option("--output", render.output, "the session folder")->required();
  add_board_options(command, arguments->options);
  add_pose_options(command, *arguments);
  add_rig_options(command, render.rig);
  add_light_options(command, render);
  add_camera_options(command, render);
  command.footer(
      "Beside session.json: calibration.yml, the true calibration, and truth/session.json, every pose's "
      "true\n"
      "camera_from_board and the true pixels of all corners.");
  command.callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace bodyscan::simulator
