#include "tools/simulator/command_options.hpp"
#include "tools/simulator/serve/serve.hpp"

#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace bodyscan::simulator {
namespace {

struct Arguments {
  ServeOptions options;
  std::vector<std::string> faults;
};

void add_prepare_option(CLI::App& command, ServeOptions& options) {
  using Prepared = std::optional<SequenceOptions>;
  const std::map<std::string, Prepared> choices{{"rows", SequenceOptions{true, false, true}},
                                                {"columns", SequenceOptions{false, true, true}},
                                                {"both", SequenceOptions{true, true, true}},
                                                {"none", std::nullopt}};
  command
      .add_option_function<std::string>(
          "--prepare", [choices, &options](const std::string& name) { options.prepare = choices.at(name); },
          "Gray-code pictures that are rendered before the world is ready (for 50 ms, ISO 200, f/8): rows, "
          "columns, both or none")
      ->check(CLI::IsMember(choices))
      ->default_str("none");
}

void add_projector_options(CLI::App& command, ServeOptions& options) {
  command.add_option("--projector", options.projector, "path of the virtual projector's socket")->required();
  command.add_option("--latency-ms", options.latency_ms, "from a page flip to its first light on the wall")
      ->capture_default_str();
  command.add_option("--rise-ms", options.rise_ms, "from its first light to all of it")
      ->capture_default_str();
}

Expected<void> run(const Arguments& arguments) {
  ServeOptions options = arguments.options;
  for (const std::string& text : arguments.faults) {
    const Expected<Fault> fault = parse_fault(text);
    if (!fault) return tl::unexpected(fault.error());
    options.faults.push_back(*fault);
  }
  return serve(options);
}

}  // namespace

void add_serve_command(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<Arguments>();
  ServeOptions& options = arguments->options;
  CLI::App& command = *app.add_subcommand("serve", "Serve a world with a camera and a projector in it");
  add_subject_options(command, options.render);
  command
      .add_option("--calibration", options.render.calibration,
                  "FILE.yml or builtin:RIG (rows, columns, diagonal)")
      ->required();
  add_projector_options(command, options);
  command.add_option("--port", options.port, "of the camera, on 127.0.0.1; 0: any that is free")
      ->capture_default_str();
  add_prepare_option(command, options);
  command
      .add_option("--fault", arguments->faults,
                  std::string("what goes wrong, any number of: ") + fault_names())
      ->delimiter(',');
  add_rig_options(command, options.render.rig, "--projector-size");
  add_light_options(command, options.render);
  add_sensor_options(command, options.render);
  command.footer(
      "The camera is a Nikon D5000 for gphoto2's PTP/IP (gphoto2 --port ptpip:127.0.0.1:PORT:PORT "
      "--summary);\n"
      "the light is that of a 50 ms exposure at ISO 200 and f/8. When both can be used, the only line on "
      "standard output\n"
      "is \"ready ptpip:127.0.0.1:PORT:PORT SOCKET\". SIGTERM or SIGINT ends it.");
  command.callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace bodyscan::simulator
