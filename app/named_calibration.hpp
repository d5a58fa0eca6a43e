#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/geometry/calibration.hpp"

#include <filesystem>
#include <string>

namespace bodyscan {

// A calibration and how reports and models name it.
struct NamedCalibration {
  Calibration calibration;
  std::string name;  // the file's name and checksum
};

Expected<NamedCalibration> read_named_calibration(const std::filesystem::path& path);

}  // namespace bodyscan
