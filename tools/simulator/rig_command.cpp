#include "pipeline/calibration/calibration_file.hpp"
#include "tools/simulator/command_options.hpp"

#include <CLI/CLI.hpp>

namespace bodyscan::simulator {

void add_rig_command(CLI::App& app, Action& action) {
  struct Arguments {
    RigOptions rig;
    std::string output;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *app.add_subcommand("rig", "Write the calibration of a built-in rig");
  command.add_option("--name", arguments->rig.name, "rows, columns or diagonal: where the projector stands")
      ->capture_default_str();
  add_rig_options(command, arguments->rig);
  command.add_option("--output", arguments->output, "the calibration file")->required();
  command.callback([arguments, &action] {
    action = [arguments]() -> Expected<void> {
      const Expected<Calibration> rig = make_rig(arguments->rig);
      if (!rig) return tl::unexpected(rig.error());
      return write_calibration(*rig, arguments->output);
    };
  });
}

}  // namespace bodyscan::simulator
