#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/geometry/calibration.hpp"

#include <filesystem>

namespace bodyscan {

// A folder of pictures and the sizes of the devices that made them.
struct PicturesOf {
  std::filesystem::path folder;
  Size camera;
  Size projector;
};

// Input error that names both, where a calibration (of a file) is of devices of other sizes.
Expected<void> check_fit(const Calibration& calibration, const std::filesystem::path& file,
                         const PicturesOf& pictures);

}  // namespace bodyscan
