#include "pipeline/base/median.hpp"
#include "tools/bench/markdown.hpp"
#include "tools/bench/parts.hpp"
#include "tools/bench/program_runs.hpp"
#include "tools/bench/served_world.hpp"

#include <cstdio>
#include <fstream>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double settle_ms = 150;
constexpr int exposure_us = 50'000;

std::vector<std::string> world_options(double scale) {
  return {"--subject", "builtin:staircase", "--calibration", "builtin:rows", "--scale", fixed(scale, 2)};
}

// The same world photographed without a camera, with the truth beside it.
Expected<void> render(double scale, const fs::path& folder) {
  std::vector<std::string> command{BODYSCAN_SIMULATOR, "render"};
  for (const std::string& option : world_options(scale)) command.push_back(option);
  command.insert(command.end(), {"--output", folder.string()});
  return run_successfully(command, "/dev/null").map([](const ProcessUsage&) {});
}

void write_rig(const fs::path& path, const fs::path& calibration, const ServedWorld& world) {
  std::ofstream(path) << "calibration = \"" << fs::absolute(calibration).string() << "\"\n[camera]\n"
                      << "backend = \"gphoto2\"\nport = \"" << world.camera_port() << "\"\n"
                      << "exposure_us = " << exposure_us
                      << "\n[projector]\nbackend = \"virtual\"\nsocket = \"" << world.projector_socket()
                      << "\"\nsettle_ms = " << settle_ms << "\n";
}

Expected<std::vector<std::string>> measure(double scale, const BenchOptions& options) {
  const fs::path folder = options.work / "scan";
  fs::remove_all(folder);
  fs::create_directories(folder);
  std::fprintf(stderr, "scan: rendering, waking the world at scale %.1f\n", scale);
  const fs::path capture = folder / "capture";
  if (const auto rendered = render(scale, capture); !rendered) return tl::unexpected(rendered.error());
  const auto rendered_model = reconstruct_capture(capture, folder / "rendered.wrl");
  if (!rendered_model) return tl::unexpected(rendered_model.error());
  const auto rendered = evaluate_model(folder / "rendered.wrl", capture);
  if (!rendered) return tl::unexpected(rendered.error());

  std::vector<std::string> arguments = world_options(scale);
  arguments.insert(arguments.end(), {"--prepare", "rows"});
  const Expected<ServedWorld> world = ServedWorld::start(arguments, folder);
  if (!world) return tl::unexpected(world.error());
  write_rig(folder / "rig.toml", capture / "calibration.yml", *world);
  std::vector<Json> runs;
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    std::fprintf(stderr, "scan: run %d of %d\n", repeat + 1, options.repeats);
    settle_disk();
    Expected<JsonRun> run =
        run_for_json({BODYSCAN_EXECUTABLE, "scan", "--rig", (folder / "rig.toml").string(), "--output",
                      (folder / "scanned.wrl").string(), "--json"},
                     folder / "scan.json");
    if (!run) return tl::unexpected(run.error());
    runs.push_back(run->result.at("scan"));
  }
  const auto scanned = evaluate_model(folder / "scanned.wrl", capture);
  if (!scanned) return tl::unexpected(scanned.error());
  const auto of = [&](const auto& figure) {
    std::vector<double> values;
    for (const Json& run : runs) values.push_back(figure(run));
    return median(values);
  };
  const auto time = [&](const char* key) {
    return of([&](const Json& run) -> double { return run.at("times_ms").at(key); });
  };
  const double shots = of([](const Json& run) -> double { return run.at("shots"); });
  const double total = time("total");
  const double least = time("exposure") + shots * settle_ms + time("camera");
  const auto seconds = [](double ms) { return fixed(ms / 1000, 2); };
  std::vector<std::string> line{
      scale < 1 ? "2144 x 1424" : "4288 x 2848",
      fixed(rendered->at("rms_mm"), 4),
      fixed(scanned->at("rms_mm"), 4),
      fixed(shots, 0),
      seconds(time("exposure")),
      seconds(shots * settle_ms),
      seconds(time("camera")),
      seconds(time("show")),
      seconds(time("fetch")),
      seconds(total),
      fixed(total / least, 2),
      seconds(of([](const Json& run) -> double { return run.at("after_last_shot_ms"); }))};
  fs::remove_all(folder);
  return line;
}

}  // namespace

Expected<std::string> scan_part(const BenchOptions& options) {
  std::vector<std::vector<std::string>> table{
      {"pictures", "RMS mm: rendered files", "scanned", "shots", "exposures s", "settle times s",
       "libgphoto2's polling s", "page flips s", "fetching s (beside settling)", "all shots s",
       "over exposures, settle times and polling", "last shot to finished model s"}};
  for (const double scale : {0.5, 1.0}) {
    Expected<std::vector<std::string>> line = measure(scale, options);
    if (!line) return tl::unexpected(line.error());
    table.push_back(std::move(*line));
  }
  return "## Scan\n\nThe staircase, scanned through libgphoto2 (PTP/IP on loopback) and the virtual "
         "projector: white, "
         "black, twenty patterns and white again; medians of " +
         std::to_string(options.repeats) + " scans. The simulated world runs on the same two cores.\n\n" +
         markdown_table(table);
}

}  // namespace bodyscan
