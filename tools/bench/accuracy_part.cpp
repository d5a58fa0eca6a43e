#include "pipeline/base/median.hpp"
#include "tools/bench/markdown.hpp"
#include "tools/bench/parts.hpp"
#include "tools/bench/program_runs.hpp"
#include "tools/bench/scenes.hpp"

#include <cmath>
#include <cstdio>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

double largest(const json& list, const char* key) {
  double value = 0;
  for (const json& one : list) value = std::max(value, std::abs(one.at(key).get<double>()));
  return value;
}

double least(const json& list, const char* key) {
  double value = 1;
  for (const json& one : list) value = std::min(value, one.at(key).get<double>());
  return value;
}

double median_of(const json& list, const char* key) {
  std::vector<double> values;
  for (const json& one : list) values.push_back(one.at(key));
  return median(values);
}

// The figures of the scene's shapes, as far as it has them.
std::string describe_shapes(const json& result) {
  std::string text;
  const auto add = [&](const std::string& figure) { text += (text.empty() ? "" : ", ") + figure; };
  if (result.contains("steps"))
    add("worst step " + fixed(largest(result["steps"], "step_error_mm"), 4) + " mm");
  if (result.contains("spheres")) {
    add("spacing " + fixed(std::abs(result.value("sphere_spacing_error_mm", 0.0)), 4));
    add("diameter " + fixed(largest(result["spheres"], "diameter_error_mm"), 4));
    add("form " + fixed(largest(result["spheres"], "form_mm"), 3) + " mm");
  }
  if (result.contains("planes"))
    add("flatness " + fixed(largest(result["planes"], "flatness_mm"), 3) + " mm");
  if (result.contains("moles")) {
    add("moles' contrast kept " + fixed(median_of(result["moles"], "contrast_kept"), 3));
    add("moles covered " + fixed(least(result["moles"], "covered"), 4));
  }
  return text;
}

std::vector<std::string> scene_line(const std::string& title, const json& result) {
  return {title,
          fixed(result.at("rms_mm"), 4),
          fixed(result.at("bias_mm"), 4),
          fixed(result.at("p95_mm"), 4),
          fixed(result.at("range_997_mm"), 3),
          fixed(result.at("share_over_1mm"), 7),
          fixed(result.at("completeness"), 5),
          describe_shapes(result)};
}

std::string bump_table(const std::vector<std::pair<std::string, json>>& results) {
  std::vector<std::vector<std::string>> lines{{"relief kept of bumps", "2 mm", "3 mm", "5 mm", "8 mm"}};
  for (const auto& [title, result] : results) {
    for (const double height : {0.1, 0.2, 0.5}) {
      std::vector<std::string> line{title + ", " + fixed(height, 1) + " mm high"};
      for (const json& bump : result.at("bumps")) {
        if (bump.at("height_mm").get<double>() == height) line.push_back(fixed(bump.at("relief_kept"), 3));
      }
      lines.push_back(line);
    }
  }
  return markdown_table(lines);
}

Expected<json> measure_scene(const BenchOptions& options, const std::string& name, double scale) {
  const fs::path capture = options.work / "capture";
  const fs::path model = options.work / "model.wrl";
  fs::remove_all(capture);
  if (auto rendered = render_scene(name, scale, capture); !rendered) return tl::unexpected(rendered.error());
  if (auto run = reconstruct_capture(capture, model); !run) return tl::unexpected(run.error());
  Expected<json> result = evaluate_model(model, capture);
  fs::remove_all(capture);
  fs::remove(model);
  return result;
}

Expected<std::string> table_at(const BenchOptions& options, const std::vector<BenchScene>& scenes,
                               double scale, const std::string& size) {
  std::vector<std::vector<std::string>> lines{{"scene at " + size, "RMS mm", "bias mm", "95 % mm",
                                               "99.7 % range mm", "over 1 mm", "completeness", "shapes"}};
  std::vector<std::pair<std::string, json>> bumps;
  for (const BenchScene& scene : scenes) {
    std::fprintf(stderr, "accuracy, %s: %s\n", size.c_str(), scene.title.c_str());
    Expected<json> result = measure_scene(options, scene.name, scale);
    if (!result) return tl::unexpected(result.error().within(scene.title));
    lines.push_back(scene_line(scene.title, *result));
    if (result->contains("bumps")) bumps.emplace_back(scene.title, std::move(*result));
  }
  const std::string table = markdown_table(lines) + "\n";
  return bumps.empty() ? table : table + bump_table(bumps) + "\n";
}

}  // namespace

Expected<std::string> accuracy_part(const BenchOptions& options) {
  const std::string text =
      "## Accuracy\n\nSimulated captures, judged against the true surface by `bodyscan-evaluate`: 22 frames "
      "(rows "
      "and columns: 42; 15 pictures: the fast sequence), projector 1024 x 768 unless said. RMS, bias and "
      "range are over all points of the "
      "model.\n\n";
  Expected<std::string> half = table_at(options, accuracy_scenes(0.5), 0.5, "2144 x 1424");
  if (!half) return half;
  std::vector<BenchScene> spheres = accuracy_scenes(1.0);
  spheres.resize(1);
  Expected<std::string> full = table_at(options, spheres, 1.0, "4288 x 2848");
  if (!full) return full;
  return text + *half + *full;
}

}  // namespace bodyscan
