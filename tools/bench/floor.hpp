#pragma once

#include "pipeline/base/error.hpp"

#include <filesystem>

namespace bodyscan {

// What no reconstruction can do without: every JPEG of a capture to luma by libjpeg-turbo, two at a time, and
// a file of the model's size written to the same disk.
struct Floor {
  double decompress_s = 0;
  double write_s = 0;
};
Expected<Floor> measure_floor(const std::filesystem::path& capture, const std::filesystem::path& output,
                              std::size_t output_bytes);

}  // namespace bodyscan
