#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace bodyscan {

// The figures of a model that was made.
struct ModelReport {
  std::size_t points = 0;
  std::size_t faces = 0;
  std::size_t pixels_lit = 0;
  std::size_t pixels_decoded = 0;
  std::vector<std::pair<std::string, std::size_t>> artifacts_removed;  // reason and how many
  double mean_uncertainty_mm = 0;                                      // of the model's points, along the ray
  std::vector<std::pair<std::string, double>> timings_ms;              // stage by stage, in order
  std::size_t peak_memory_bytes = 0;
  std::string software;
  std::string calibration;  // the file's name and checksum
};

// One JSON object with the keys of the reconstruct report.
std::string to_json(const ModelReport& report);

// The same for a report that says more.
nlohmann::ordered_json json_of(const ModelReport& report);

// A report's text: UTF-8 whatever names it holds.
std::string text_of(const nlohmann::ordered_json& json);

}  // namespace bodyscan
