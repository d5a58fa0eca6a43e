#include "tools/simulator/command_options.hpp"

#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

namespace bodyscan::simulator {
namespace {

constexpr int usage_status = 2;
constexpr int input_status = 3;

int run(int argc, char** argv) {
  CLI::App app("Renders what a structured-light scanner's camera would see.");
  app.require_subcommand(1);
  Action action;
  add_render_command(app, action);
  add_calibration_command(app, action);
  add_rig_command(app, action);
  add_serve_command(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : usage_status;
  }
  const Expected<void> done = action();
  if (done) return 0;
  std::fprintf(stderr, "bodyscan-simulator: %s\n", done.error().message.c_str());
  return done.error().kind == ErrorKind::usage ? usage_status : input_status;
}

}  // namespace
}  // namespace bodyscan::simulator

int main(int argc, char** argv) {
  try {
    return bodyscan::simulator::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bodyscan-simulator: %s\n", error.what());
    return 1;
  }
}
