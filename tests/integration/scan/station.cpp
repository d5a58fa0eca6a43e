#include "station.hpp"

#include "tests/support/test_files.hpp"

#include <algorithm>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> serve_options(const std::string& fault) {
  std::vector<std::string> options = scene_options();
  options.insert(options.end(), {"--calibration", "builtin:rows", "--projector-size", "256x192", "--prepare",
                                 "rows", "--latency-ms", "5", "--rise-ms", "5"});
  if (!fault.empty()) options.insert(options.end(), {"--fault", fault});
  return options;
}

}  // namespace

std::vector<std::string> scene_options() {
  return {"--subject", "builtin:head", "--detail", "2", "--scale", "0.12", "--rays", "1"};
}

Station::Station(const std::string& fault) : world_(serve_options(fault)) {
  run_program({BODYSCAN_SIMULATOR, "rig", "--scale", "0.12", "--projector", "256x192", "--output",
               world_.folder() / "calibration.yml"});
  // As much light as the 50 ms at ISO 200 that the world's pictures are prepared for.
  write_text(rig(),
             "calibration = \"calibration.yml\"\n"
             "[camera]\nbackend = \"gphoto2\"\nport = \"" +
                 world_.camera() +
                 "\"\nexposure_us = 12500\niso = 800\naperture = 8.0\n"
                 "[projector]\nbackend = \"virtual\"\nsocket = \"projector\"\nsettle_ms = 30\n");
}

RunningScan Station::start() {
  fs::remove_all(results());
  fs::create_directory(results());
  return RunningScan({BODYSCAN_EXECUTABLE, "scan", "--rig", rig(), "--output", model(), "--report",
                      results() / "report.json"},
                     world_.folder() / "standard_error");
}

std::vector<std::string> Station::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(results())) names.push_back(entry.path().filename());
  std::ranges::sort(names);
  return names;
}

nlohmann::json Station::report() const {
  const auto whole = nlohmann::json::parse(read_text(results() / "report.json"), nullptr, false);
  if (whole.is_discarded() || !whole.contains("scan")) {
    ADD_FAILURE() << "no report";
    return {};
  }
  return whole["scan"];
}

}  // namespace bodyscan
