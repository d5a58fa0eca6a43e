#include "tools/evaluate/evaluation.hpp"

#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

int main(int count, char** arguments) {
  CLI::App app("Judges a model against what the simulator knows about the capture it was made from.",
               "bodyscan-evaluate");
  std::string model;
  std::string capture;
  bool json = false;
  app.add_option("MODEL", model, "VRML model, mm in the camera frame")->required();
  app.add_option("CAPTURE_DIR", capture, "capture folder with calibration.yml and truth/")->required();
  app.add_flag("--json", json, "one JSON object instead of the table");
  try {
    app.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    const bodyscan::Expected<bodyscan::Evaluation> evaluation = bodyscan::evaluate_files(model, capture);
    if (!evaluation) {
      std::fprintf(stderr, "bodyscan-evaluate: %s\n", evaluation.error().message.c_str());
      return 3;
    }
    std::fputs((json ? to_json(*evaluation) : to_table(*evaluation)).c_str(), stdout);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bodyscan-evaluate: %s\n", error.what());
    return 3;
  }
  return 0;
}
