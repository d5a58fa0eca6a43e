#include "app/command_line.hpp"

#include "app/console.hpp"
#include "app/version.hpp"

#include <iostream>
#include <new>
#include <string>

#include <CLI/CLI.hpp>

namespace bodyscan {
namespace {

ExitStatus run(const Action& action) {
  try {
    const Expected<void> outcome = action();
    if (outcome) return ExitStatus::done;
    print_error(outcome.error().message);
    return exit_status_of(outcome.error().kind);
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
    return ExitStatus::file;
  } catch (const std::exception& error) {
    print_error(error.what());
    return ExitStatus::file;
  }
}

}  // namespace

ExitStatus run_command_line(int argc, const char* const* argv) {
  CLI::App app("Structured-light body scanner: photographs of projected stripes become a coloured 3D model.",
               "bodyscan");
  app.set_version_flag("--version", std::string(software_version()));
  app.require_subcommand(0, 1);
  app.footer(
      "Exit status: 0 done, 2 wrong command line, 3 a file is missing, damaged, inconsistent or cannot be\n"
      "written, 4 a device failed, 5 the store failed, 6 the result does not reach the quality asked for.");
  Action action;
  add_scan_command(app, action);
  add_rig_command(app, action);
  add_calibrate_command(app, action);
  add_reconstruct_command(app, action);
  add_board_command(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // CLI11 prints help and version through this too.
    return app.exit(error, std::cout, std::cerr) == 0 ? ExitStatus::done : ExitStatus::usage;
  }
  if (!action) {
    std::cerr << app.help();
    print_error("a command is missing");
    return ExitStatus::usage;
  }
  return run(action);
}

}  // namespace bodyscan
