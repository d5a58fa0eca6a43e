#pragma once

#include "app/exit_status.hpp"

#include <functional>

namespace CLI {
class App;
}

namespace bodyscan {

// What a command does once its options are known. The message of an error starts with the file or device.
using Action = std::function<Expected<void>()>;

// Parses the command line and runs the command it names; every error is printed on standard error.
ExitStatus run_command_line(int argc, const char* const* argv);

// Each command adds itself: its name, options and help to `app`, and, if it is the one named, what it does to
// `action`.
void add_board_command(CLI::App& app, Action& action);
void add_calibrate_command(CLI::App& app, Action& action);
void add_reconstruct_command(CLI::App& app, Action& action);
void add_rig_command(CLI::App& app, Action& action);
void add_scan_command(CLI::App& app, Action& action);

}  // namespace bodyscan
