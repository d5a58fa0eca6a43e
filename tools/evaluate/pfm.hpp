#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"
#include "pipeline/geometry/point_grid.hpp"

#include <filesystem>

namespace bodyscan {

// Portable float maps, little-endian; in the file the bottom row comes first, here the top row does.
Expected<FloatImage> read_pfm(const std::filesystem::path& file);              // "Pf", one channel
Expected<Image<Point3f>> read_pfm_vectors(const std::filesystem::path& file);  // "PF", three channels

}  // namespace bodyscan
