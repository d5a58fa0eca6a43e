#include "pipeline/base/median.hpp"
#include "tools/bench/markdown.hpp"
#include "tools/bench/parts.hpp"
#include "tools/bench/program_runs.hpp"

#include <cstdio>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr double interval_s = 0.9;

}  // namespace

Expected<std::string> streaming_part(const BenchOptions& options) {
  const fs::path capture = options.work / "streaming";
  const fs::path model = options.work / "streaming.wrl";
  fs::remove_all(capture);
  std::fprintf(stderr, "streaming: rendering\n");
  if (auto rendered = render_scene("growth", 1.0, capture); !rendered)
    return tl::unexpected(rendered.error());
  std::vector<json> runs;
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    std::fprintf(stderr, "streaming: run %d of %d\n", repeat + 1, options.repeats);
    settle_disk();
    Expected<JsonRun> run =
        run_for_json(own_command({"paced", capture.string(), model.string(), fixed(interval_s, 3)}),
                     model.string() + ".json");
    if (!run) return tl::unexpected(run.error());
    runs.push_back(std::move(run->result));
  }
  fs::remove_all(capture);
  fs::remove(model);

  const auto of = [&](const char* key) {
    std::vector<double> values;
    for (const json& run : runs) values.push_back(run.at(key));
    return median(values);
  };
  const auto line = [&](const char* title, const char* key) {
    return std::vector<std::string>{title, fixed(1000 * of(key), 0),
                                    fixed(100 * of(key) / of("compute_s"), 1)};
  };
  return "## Streaming\n\nFrames of 4288 x 2848 that arrive every " + fixed(1000 * interval_s, 0) +
         " ms are decoded as they come; medians of " + std::to_string(options.repeats) + " runs.\n\n" +
         markdown_table({{"figure", "ms", "% of all computing"},
                         line("last arrival to complete correspondence", "correspondence_s"),
                         line("last arrival to finished model file", "model_s"),
                         line("longest time for an earlier frame", "frame_s"),
                         line("all computing", "compute_s")});
}

}  // namespace bodyscan
