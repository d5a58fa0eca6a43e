#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/image/codec.hpp"

#include <cstddef>
#include <span>

namespace bodyscan::detail {

bool is_png(std::span<const std::byte> file);
Expected<Size> png_size(std::span<const std::byte> file, const ImageLimits& limits);
Expected<void> decode_png_luma(std::span<const std::byte> file, const ImageLimits& limits, Luma& luma);
Expected<ColorImage8> decode_png_color(std::span<const std::byte> file, const ImageLimits& limits);

}  // namespace bodyscan::detail
