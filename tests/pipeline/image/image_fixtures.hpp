#pragma once

#include "pipeline/base/image.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bodyscan {

struct JpegOptions {
  int quality = 95;
  int chroma_step_x = 1;  // 2 x 1 is 4:2:2
  int chroma_step_y = 1;
  bool progressive = false;
};

std::vector<std::byte> make_jpeg(const ColorImage8& image, const JpegOptions& options = {});
std::vector<std::byte> make_gray_jpeg(const GrayImage8& image);
std::vector<std::byte> make_cmyk_jpeg(Size size);

// The same file with another size in its header (a baseline or progressive JPEG, or a PNG with its checksum).
std::vector<std::byte> jpeg_claiming(std::vector<std::byte> file, Size size);
std::vector<std::byte> png_claiming(std::vector<std::byte> file, std::uint32_t width, std::uint32_t height);

struct PngOptions {
  int color_type = 0;  // PNG_COLOR_TYPE_...
  int depth = 8;
  bool interlaced = false;
  double gamma = 0;  // a gAMA chunk if above zero
};

// `samples` as PNG stores them (16 bits big-endian, below 8 bits packed), rows padded to whole bytes. A
// palette image has the palette of colour i = (2 i, 255 - i, i / 2).
std::vector<std::byte> make_png(Size size, const PngOptions& options, std::span<const std::uint8_t> samples);

// A smooth picture with differing channels.
ColorImage8 colorful(Size size);

}  // namespace bodyscan
