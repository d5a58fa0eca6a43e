// The benchmarks that docs/benchmarks.md holds. Its subcommands render, floor and paced are the parts of a
// measurement that need a process of their own.
#include "tools/bench/floor.hpp"
#include "tools/bench/machine.hpp"
#include "tools/bench/markdown.hpp"
#include "tools/bench/paced_run.hpp"
#include "tools/bench/parts.hpp"
#include "tools/bench/scenes.hpp"
#include "tools/simulator/capture_folder.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <iostream>
#include <utility>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

using Part = Expected<std::string> (*)(const BenchOptions&);
constexpr std::array<std::pair<const char*, Part>, 7> parts{{{"accuracy", accuracy_part},
                                                             {"calibration", calibration_part},
                                                             {"speed", speed_part},
                                                             {"growth", growth_part},
                                                             {"streaming", streaming_part},
                                                             {"scan", scan_part},
                                                             {"executable", executable_part}}};

Expected<void> run_parts(const std::vector<std::string>& wanted, const BenchOptions& options,
                         const std::string& commit, const std::string& document) {
  std::filesystem::create_directories(options.work);
  for (const auto& [name, part] : parts) {
    if (!wanted.empty() && std::ranges::find(wanted, name) == wanted.end()) continue;
    const Expected<std::string> text = part(options);
    if (!text) return tl::unexpected(text.error().within(name));
    const std::string dated =
        *text + "\n" + describe_machine() + "; " + today() + ", commit " + commit + ".\n";
    std::cout << dated << std::endl;
    if (auto replaced = replace_section(document, name, dated); !replaced) return replaced;
  }
  return {};
}

Expected<void> render(const std::string& name, double scale, const std::string& folder) {
  Expected<BenchScene> scene = bench_scene(name, scale);
  if (!scene) return tl::unexpected(scene.error());
  scene->options.output = folder;
  if (auto rendered = simulator::render_capture(scene->options); !rendered) {
    return tl::unexpected(rendered.error());
  }
  return {};
}

Expected<void> print_floor(const std::string& capture, const std::string& output, std::size_t bytes) {
  const Expected<Floor> floor = measure_floor(capture, output, bytes);
  if (!floor) return tl::unexpected(floor.error());
  std::cout << nlohmann::json{{"decompress_s", floor->decompress_s}, {"write_s", floor->write_s}} << "\n";
  return {};
}

Expected<void> print_paced(const std::string& capture, const std::string& model, double interval_s) {
  const Expected<PacedRun> run = run_paced(capture, model, interval_s);
  if (!run) return tl::unexpected(run.error());
  std::cout << nlohmann::json{{"frames", run->frames},
                              {"correspondence_s", run->correspondence_s},
                              {"model_s", run->model_s},
                              {"frame_s", run->frame_s},
                              {"compute_s", run->compute_s}}
            << "\n";
  return {};
}

Expected<void> run_command_line(int count, char** arguments) {
  CLI::App app("Measures the product and puts the tables into a document.", "bodyscan-bench");
  app.require_subcommand(1);
  Expected<void> result;

  std::vector<std::string> wanted;
  BenchOptions options;
  std::string commit;
  std::string document;
  std::vector<std::string> names;
  for (const auto& [name, part] : parts) names.emplace_back(name);
  CLI::App* measure = app.add_subcommand("measure", "measure and write the tables");
  measure->add_option("PARTS", wanted, "which parts; none named: all")->check(CLI::IsMember(names));
  measure->add_option("--work", options.work, "folder for scenes and models, some GB")->required();
  measure->add_option("--document", document, "Markdown file whose sections are replaced")->required();
  measure->add_option("--commit", commit, "what is measured")->required();
  measure->add_option("--repeats", options.repeats, "of each timing")->check(CLI::Range(1, 100));
  measure->callback([&] { result = run_parts(wanted, options, commit, document); });

  std::string first;
  std::string second;
  double number = 0;
  std::size_t bytes = 0;
  CLI::App* render_one = app.add_subcommand("render", "render one bench scene");
  render_one->add_option("NAME", first)->required();
  render_one->add_option("SCALE", number)->required();
  render_one->add_option("FOLDER", second)->required();
  render_one->callback([&] { result = render(first, number, second); });

  CLI::App* floor = app.add_subcommand("floor", "decompress a capture's JPEGs and write BYTES, as JSON");
  floor->add_option("CAPTURE", first)->required();
  floor->add_option("OUTPUT", second)->required();
  floor->add_option("BYTES", bytes)->required();
  floor->callback([&] { result = print_floor(first, second, bytes); });

  CLI::App* paced = app.add_subcommand("paced", "decode a capture whose frames arrive one by one, as JSON");
  paced->add_option("CAPTURE", first)->required();
  paced->add_option("MODEL", second)->required();
  paced->add_option("INTERVAL_S", number)->required();
  paced->callback([&] { result = print_paced(first, second, number); });

  try {
    app.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    if (app.exit(error) != 0) return tl::unexpected(Error{ErrorKind::usage, "wrong command line"});
  }
  return result;
}

}  // namespace
}  // namespace bodyscan

int main(int count, char** arguments) {
  try {
    const bodyscan::Expected<void> result = bodyscan::run_command_line(count, arguments);
    if (result) return 0;
    std::fprintf(stderr, "bodyscan-bench: %s\n", result.error().message.c_str());
    return result.error().kind == bodyscan::ErrorKind::usage ? 2 : 3;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bodyscan-bench: %s\n", error.what());
    return 3;
  }
}
