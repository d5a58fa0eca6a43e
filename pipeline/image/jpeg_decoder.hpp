#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/image/codec.hpp"

#include <cstddef>
#include <span>

namespace bodyscan::detail {

bool is_jpeg(std::span<const std::byte> file);
Expected<Size> jpeg_size(std::span<const std::byte> file, const ImageLimits& limits);
Expected<void> decode_jpeg_luma(std::span<const std::byte> file, const ImageLimits& limits, Luma& luma);
Expected<ColorImage8> decode_jpeg_color(std::span<const std::byte> file, const ImageLimits& limits);

}  // namespace bodyscan::detail
