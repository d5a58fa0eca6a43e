#include "pipeline/image/codec.hpp"

#include "pipeline/image/jpeg_decoder.hpp"
#include "pipeline/image/png_decoder.hpp"

#include <string>

namespace bodyscan {
namespace {

enum class Format { jpeg, png };

Expected<Format> recognise(std::span<const std::byte> file, const ImageLimits& limits) {
  if (file.size() > limits.max_file_bytes)
    return input_error("an image file of " + std::to_string(file.size()) + " bytes is over the limit of " +
                       std::to_string(limits.max_file_bytes));
  if (file.empty()) return input_error("the file is empty");
  if (detail::is_jpeg(file)) return Format::jpeg;
  if (detail::is_png(file)) return Format::png;
  return input_error("not a JPEG or PNG file");
}

}  // namespace

Expected<Size> read_size(std::span<const std::byte> file, const ImageLimits& limits) {
  const Expected<Format> format = recognise(file, limits);
  if (!format) return tl::unexpected(format.error());
  return *format == Format::jpeg ? detail::jpeg_size(file, limits) : detail::png_size(file, limits);
}

Expected<void> decode_luma_into(std::span<const std::byte> file, Luma& luma, const ImageLimits& limits) {
  const Expected<Format> format = recognise(file, limits);
  if (!format) return tl::unexpected(format.error());
  return *format == Format::jpeg ? detail::decode_jpeg_luma(file, limits, luma)
                                 : detail::decode_png_luma(file, limits, luma);
}

Expected<Luma> decode_luma(std::span<const std::byte> file, const ImageLimits& limits) {
  Luma luma;
  if (Expected<void> decoded = decode_luma_into(file, luma, limits); !decoded)
    return tl::unexpected(decoded.error());
  return luma;
}

Expected<ColorImage8> decode_color(std::span<const std::byte> file, const ImageLimits& limits) {
  const Expected<Format> format = recognise(file, limits);
  if (!format) return tl::unexpected(format.error());
  return *format == Format::jpeg ? detail::decode_jpeg_color(file, limits)
                                 : detail::decode_png_color(file, limits);
}

}  // namespace bodyscan
