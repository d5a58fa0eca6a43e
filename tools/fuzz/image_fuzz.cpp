#include "pipeline/image/codec.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> file(reinterpret_cast<const std::byte*>(data), size);
  const bodyscan::ImageLimits limits{.max_side_px = 1024, .max_pixels = 1 << 14, .max_jpeg_scans = 10};
  const auto header = bodyscan::read_size(file, limits);
  const auto luma = bodyscan::decode_luma(file, limits);
  const auto color = bodyscan::decode_color(file, limits);
  if (luma && (!header || bodyscan::size_of(*luma) != *header)) std::abort();
  if (color && (!header || color->size() != *header)) std::abort();
  return 0;
}
