#include "app/model_report.hpp"

#include <nlohmann/json.hpp>

namespace bodyscan {

using Json = nlohmann::ordered_json;

Json json_of(const ModelReport& report) {
  Json removed = Json::object();
  for (const auto& [reason, count] : report.artifacts_removed) removed[reason] = count;
  Json timings = Json::object();
  for (const auto& [stage, milliseconds] : report.timings_ms) timings[stage] = milliseconds;
  const auto lit = static_cast<double>(report.pixels_lit);
  return {
      {"points", report.points},
      {"faces", report.faces},
      {"pixels_lit", report.pixels_lit},
      {"pixels_decoded", report.pixels_decoded},
      {"decoded_fraction", report.pixels_lit == 0 ? 0 : static_cast<double>(report.pixels_decoded) / lit},
      {"artifacts_removed", removed},
      {"mean_uncertainty_mm", report.mean_uncertainty_mm},
      {"timings_ms", timings},
      {"peak_memory_bytes", report.peak_memory_bytes},
      {"software", report.software},
      {"calibration", report.calibration},
  };
}

std::string to_json(const ModelReport& report) {
  return text_of(json_of(report));
}

std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace bodyscan
