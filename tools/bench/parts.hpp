#pragma once

#include "pipeline/base/error.hpp"

#include <filesystem>
#include <string>

namespace bodyscan {

struct BenchOptions {
  std::filesystem::path work;  // folder for scenes and models; on the disk that is measured
  int repeats = 5;             // of each timing; the median counts
};

// Each measures one subject and returns its tables in Markdown. Progress goes to standard error.
Expected<std::string> accuracy_part(const BenchOptions& options);
Expected<std::string> calibration_part(const BenchOptions& options);
Expected<std::string> speed_part(const BenchOptions& options);
Expected<std::string> growth_part(const BenchOptions& options);
Expected<std::string> streaming_part(const BenchOptions& options);
Expected<std::string> scan_part(const BenchOptions& options);
Expected<std::string> executable_part(const BenchOptions& options);

}  // namespace bodyscan
