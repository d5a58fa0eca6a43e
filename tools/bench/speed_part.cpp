#include "pipeline/base/median.hpp"
#include "tools/bench/link_capture.hpp"
#include "tools/bench/markdown.hpp"
#include "tools/bench/parts.hpp"
#include "tools/bench/program_runs.hpp"

#include <cstdio>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

// One program's runs over the same capture.
struct Contender {
  std::string title;
  std::string frames;
  std::vector<std::string> command;
  fs::path capture;  // what its model is judged against
  fs::path model;
  std::vector<double> wall_s = {};
  std::vector<double> cpu_s = {};
  double peak_memory_mb = 0;
};

struct FloorTimes {
  std::vector<double> decompress_s;
  std::vector<double> write_s;
};

Expected<void> run_once(Contender& contender) {
  // A scan makes a new file; replacing one costs its file system a flush.
  fs::remove(contender.model);
  settle_disk();
  const Expected<ProcessUsage> usage = run_successfully(contender.command);
  if (!usage) return tl::unexpected(usage.error());
  contender.wall_s.push_back(usage->wall_s);
  contender.cpu_s.push_back(usage->cpu_s);
  contender.peak_memory_mb = std::max(contender.peak_memory_mb, usage->peak_memory_mb);
  std::fprintf(stderr, "speed: %s %.2f s, %.0f MB\n", contender.title.c_str(), usage->wall_s,
               usage->peak_memory_mb);
  return {};
}

Expected<void> run_floor(const fs::path& capture, const fs::path& output, std::uintmax_t bytes,
                         FloorTimes& times) {
  settle_disk();
  const Expected<JsonRun> run =
      run_for_json(own_command({"floor", capture.string(), output.string(), std::to_string(bytes)}),
                   output.string() + ".json");
  if (!run) return tl::unexpected(run.error());
  times.decompress_s.push_back(run->result.at("decompress_s"));
  times.write_s.push_back(run->result.at("write_s"));
  fs::remove(output);
  return {};
}

std::string spread(const std::vector<double>& values) {
  return fixed(median(values), 2) + " (" + fixed(*std::ranges::min_element(values), 2) + " to " +
         fixed(*std::ranges::max_element(values), 2) + ")";
}

Expected<std::vector<std::string>> contender_line(const Contender& contender) {
  const Expected<json> judged = evaluate_model(contender.model, contender.capture);
  if (!judged) return tl::unexpected(judged.error());
  return std::vector<std::string>{contender.title,
                                  contender.frames,
                                  spread(contender.wall_s),
                                  fixed(median(contender.cpu_s), 2),
                                  fixed(contender.peak_memory_mb, 0),
                                  std::to_string(judged->at("points").get<std::size_t>()),
                                  std::to_string(judged->at("faces").get<std::size_t>()),
                                  fixed(static_cast<double>(fs::file_size(contender.model)) * 1e-6, 0),
                                  fixed(judged->at("rms_mm"), 3),
                                  fixed(judged->at("share_over_1mm"), 6),
                                  fixed(judged->at("completeness"), 4)};
}

std::string ratio_table(const std::vector<Contender>& contenders, const FloorTimes& floor) {
  const double ours = median(contenders[0].wall_s);
  const double decompress = median(floor.decompress_s);
  const double write = median(floor.write_s);
  std::vector<std::vector<std::string>> lines{{"ratio", "value"}};
  lines.push_back({"ours / (decompressing + writing)", fixed(ours / (decompress + write), 2)});
  lines.push_back({"(ours - writing) / decompressing", fixed((ours - write) / decompress, 2)});
  for (std::size_t i = 1; i < contenders.size(); ++i) {
    lines.push_back({contenders[i].title + " / ours", fixed(median(contenders[i].wall_s) / ours, 2)});
  }
  return markdown_table(lines);
}

std::string stage_table(const json& report) {
  std::vector<std::vector<std::string>> lines{{"stage of ours", "ms"}};
  for (const auto& [stage, ms] : report.at("timings_ms").items()) lines.push_back({stage, fixed(ms, 0)});
  return markdown_table(lines);
}

std::vector<Contender> contenders_for(const fs::path& rows, const fs::path& both, const fs::path& work) {
  const std::string rig = (both / "calibration.yml").string();
  const auto peer = [&](const char* title, const char* frames, const char* program, const fs::path& capture) {
    const fs::path model = work / (fs::path(program).filename().string() + ".wrl");
    return Contender{title, frames, {program, capture.string(), rig, model.string()}, capture, model};
  };
  const fs::path model = work / "ours.wrl";
  return {
      {"bodyscan",
       "22",
       {BODYSCAN_EXECUTABLE, "reconstruct", rows.string(), "--calibration", rig, "--output", model.string()},
       rows,
       model},
      peer("plain OpenCV, ray and plane (points only)", "22", BODYSCAN_PEER_PLAIN, rows),
      peer("OpenCV structured_light (points only)", "42", BODYSCAN_PEER_STRUCTURED_LIGHT, both)};
}

}  // namespace

Expected<std::string> speed_part(const BenchOptions& options) {
  const fs::path both = options.work / "speed";
  const fs::path rows = options.work / "speed_rows";
  fs::remove_all(both);
  fs::remove_all(rows);
  std::fprintf(stderr, "speed: rendering 42 frames of 4288 x 2848\n");
  if (auto rendered = render_scene("speed", 1.0, both); !rendered) return tl::unexpected(rendered.error());
  if (auto linked = link_capture(both, rows, true); !linked) return tl::unexpected(linked.error());

  std::vector<Contender> contenders = contenders_for(rows, both, options.work);
  FloorTimes floor;
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    for (Contender& contender : contenders) {
      if (auto run = run_once(contender); !run) return tl::unexpected(run.error());
      if (&contender != &contenders[0]) continue;
      const auto bytes = fs::file_size(contender.model);
      if (auto run = run_floor(rows, options.work / "floor.bin", bytes, floor); !run) {
        return tl::unexpected(run.error());
      }
    }
  }

  std::vector<std::vector<std::string>> lines{{"program", "frames", "time s: median (range)", "CPU s",
                                               "peak memory MB", "points", "faces", "file MB", "RMS mm",
                                               "over 1 mm", "completeness"}};
  for (const Contender& contender : contenders) {
    auto line = contender_line(contender);
    if (!line) return tl::unexpected(line.error());
    lines.push_back(*line);
  }
  lines.push_back({"floor: libjpeg-turbo to luma, two threads", "22", spread(floor.decompress_s), "", "", "",
                   "", "", "", "", ""});
  lines.push_back({"floor: writing the bytes of bodyscan's file", "", spread(floor.write_s), "", "", "", "",
                   "", "", "", ""});
  const Expected<JsonRun> stages = reconstruct_capture(rows, contenders[0].model);
  if (!stages) return tl::unexpected(stages.error());
  std::string text =
      "## Speed\n\nA torso that fills half of the picture, 4288 x 2848 JPEG photographs to a finished VRML "
      "file; " +
      std::to_string(options.repeats) + " interleaved runs. The peers write points only.\n\n" +
      markdown_table(lines) + "\n" + ratio_table(contenders, floor) + "\n" + stage_table(stages->result);
  for (const Contender& contender : contenders) fs::remove(contender.model);
  fs::remove_all(rows);
  fs::remove_all(both);
  return text;
}

}  // namespace bodyscan
