#include "pipeline/base/median.hpp"
#include "tools/bench/markdown.hpp"
#include "tools/bench/parts.hpp"
#include "tools/bench/program_runs.hpp"

#include <cmath>
#include <cstdio>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;

constexpr double full_megapixels = 4288e-3 * 2848e-3;

Expected<std::vector<std::string>> measure_size(const BenchOptions& options, int megapixels) {
  const fs::path capture = options.work / "growth";
  const fs::path model = options.work / "growth.wrl";
  fs::remove_all(capture);
  std::fprintf(stderr, "growth: %d megapixels\n", megapixels);
  const double scale = std::sqrt(megapixels / full_megapixels);
  if (auto rendered = render_scene("growth", scale, capture); !rendered)
    return tl::unexpected(rendered.error());
  std::vector<double> ours_s;
  std::vector<double> floor_s;
  double peak_memory_mb = 0;
  std::size_t points = 0;
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    settle_disk();
    const Expected<JsonRun> run = reconstruct_capture(capture, model);
    if (!run) return tl::unexpected(run.error());
    ours_s.push_back(run->usage.wall_s);
    peak_memory_mb = std::max(peak_memory_mb, run->usage.peak_memory_mb);
    points = run->result.at("points");
    const std::string bytes = std::to_string(fs::file_size(model));
    fs::remove(model);
    settle_disk();
    const Expected<JsonRun> floor = run_for_json(
        own_command({"floor", capture.string(), model.string(), bytes}), model.string() + ".json");
    if (!floor) return tl::unexpected(floor.error());
    floor_s.push_back(floor->result.at("decompress_s").get<double>() +
                      floor->result.at("write_s").get<double>());
    fs::remove(model);
  }
  fs::remove_all(capture);
  const double seconds = median(ours_s);
  return std::vector<std::string>{std::to_string(megapixels),
                                  std::to_string(points),
                                  fixed(seconds, 2),
                                  fixed(1000 * seconds / megapixels, 0),
                                  fixed(peak_memory_mb, 0),
                                  fixed(median(floor_s), 2),
                                  fixed(seconds / median(floor_s), 2)};
}

}  // namespace

Expected<std::string> growth_part(const BenchOptions& options) {
  std::vector<std::vector<std::string>> lines{
      {"megapixels", "points", "time s", "ms a megapixel", "peak memory MB", "floor s", "time / floor"}};
  for (const int megapixels : {3, 6, 12, 24}) {
    auto line = measure_size(options, megapixels);
    if (!line) return tl::unexpected(line.error());
    lines.push_back(*line);
  }
  return "## Growth\n\nThe same scene at four picture sizes, 22 frames; medians of " +
         std::to_string(options.repeats) +
         " runs. Floor: decompressing to luma and writing as many bytes.\n\n" + markdown_table(lines);
}

}  // namespace bodyscan
