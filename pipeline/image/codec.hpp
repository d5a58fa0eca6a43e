#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/image/frame.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace bodyscan {

// What an image file may ask for; checked against its header, before any pixel is allocated.
struct ImageLimits {
  int max_side_px = 16384;
  std::size_t max_pixels = 64'000'000;
  std::size_t max_file_bytes = std::size_t{256} << 20;
  int max_jpeg_scans = 100;  // a progressive file of many tiny scans costs a full pass for each
};

// The functions below take a whole JPEG or PNG file. A file over the limits, damaged, truncated or of another
// format is an error; libjpeg's warnings count as damage. Alpha is ignored, no colour profile is applied, and
// bytes after the image's end are allowed (cameras append previews).

// From the header alone; the pixels may still be damaged.
Expected<Size> read_size(std::span<const std::byte> file, const ImageLimits& limits = {});

// Brightness as stored: a JPEG's Y without colour conversion; a PNG's grey or 0.299 R + 0.587 G + 0.114 B
// (ITU-R BT.601), in 16 bits if the PNG has them and 8 otherwise.
Expected<Luma> decode_luma(std::span<const std::byte> file, const ImageLimits& limits = {});

// The same into `luma`, whose memory is used again if it has the right size and depth; unspecified pixels
// after an error.
Expected<void> decode_luma_into(std::span<const std::byte> file, Luma& luma, const ImageLimits& limits = {});

// Colour as stored, in 8 bits (16-bit PNG values are rounded); grey is repeated.
Expected<ColorImage8> decode_color(std::span<const std::byte> file, const ImageLimits& limits = {});

// A PNG file of an image that is not empty.
Expected<std::vector<std::byte>> encode_png(const GrayImage8& image);
Expected<std::vector<std::byte>> encode_png(const GrayImage16& image);
Expected<std::vector<std::byte>> encode_png(const ColorImage8& image);

}  // namespace bodyscan
