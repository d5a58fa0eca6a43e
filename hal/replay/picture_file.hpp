#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/image/codec.hpp"

#include <filesystem>

namespace bodyscan {

// A photograph's file; messages start with its path.

// The size that its header declares; the pixels may still be damaged. Reads little more than the header.
Expected<Size> declared_size(const std::filesystem::path& path, const ImageLimits& limits);

Expected<Luma> load_luma(const std::filesystem::path& path, const ImageLimits& limits);

}  // namespace bodyscan
