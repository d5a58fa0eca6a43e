#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/image/codec.hpp"

#include <cstdint>
#include <string>

namespace bodyscan::detail {

inline Expected<Size> checked_size(std::uint32_t width, std::uint32_t height, const ImageLimits& limits) {
  const auto side = static_cast<std::uint32_t>(limits.max_side_px);
  const std::string text = std::to_string(width) + " x " + std::to_string(height) + " pixels";
  if (width == 0 || height == 0) return input_error("an image of " + text);
  if (width > side || height > side)
    return input_error(text + ": over the limit of " + std::to_string(side) + " a side");
  if (std::uint64_t{width} * height > limits.max_pixels)
    return input_error(text + ": over the limit of " + std::to_string(limits.max_pixels) + " pixels");
  return Size{static_cast<int>(width), static_cast<int>(height)};
}

// The image in `luma` with this pixel type and size; its memory is kept if it fits already.
template <class Pixel>
Image<Pixel>& reuse(Luma& luma, Size size) {
  if (!std::holds_alternative<Image<Pixel>>(luma) || size_of(luma) != size) {
    luma = Image<Pixel>();  // the old memory goes before the new comes
    luma = Image<Pixel>(size);
  }
  return std::get<Image<Pixel>>(luma);
}

}  // namespace bodyscan::detail
