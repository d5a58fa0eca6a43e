#include "pipeline/image/codec.hpp"

#include <array>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <string>

#include <png.h>

namespace bodyscan {
namespace {

struct PngTrouble {
  std::jmp_buf escape;
  std::array<char, 160> message;
};

[[noreturn]] void give_up(png_structp png, png_const_charp message) {
  auto* trouble = static_cast<PngTrouble*>(png_get_error_ptr(png));
  std::snprintf(trouble->message.data(), trouble->message.size(), "%s", message);
  std::longjmp(trouble->escape, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

bool append(std::vector<std::byte>& file, const std::byte* bytes, std::size_t count) noexcept try {
  file.insert(file.end(), bytes, bytes + count);
  return true;
} catch (...) {
  return false;
}

void write_bytes(png_structp png, png_bytep source, std::size_t count) {
  auto* file = static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
  if (!append(*file, reinterpret_cast<const std::byte*>(source), count)) png_error(png, "out of memory");
}

void flush_nothing(png_structp) {}

// Level 3 of zlib: pictures of a scene shrink little more at the default 6, in about three times the time.
constexpr int compression_level = 3;

class PngEncoder {
 public:
  PngEncoder() {
    png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, &trouble_, give_up, ignore_warning);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
  }
  PngEncoder(const PngEncoder&) = delete;
  PngEncoder& operator=(const PngEncoder&) = delete;
  ~PngEncoder() { png_destroy_write_struct(&png_, &info_); }

  template <class Pixel>
  [[nodiscard]] bool encode(const Image<Pixel>& image, int depth, int color_type) {
    if (png_ == nullptr || info_ == nullptr) return false;
    if (setjmp(trouble_.escape) != 0) return false;
    png_set_write_fn(png_, &file_, write_bytes, flush_nothing);
    png_set_compression_level(png_, compression_level);
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(image.width()),
                 static_cast<png_uint_32>(image.height()), depth, color_type, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png_, info_);
    if (std::endian::native == std::endian::little) png_set_swap(png_);
    for (int y = 0; y < image.height(); ++y)
      png_write_row(png_, reinterpret_cast<png_const_bytep>(image.row(y)));
    png_write_end(png_, info_);
    return true;
  }

  [[nodiscard]] std::string message() const { return std::string("PNG: ") + trouble_.message.data(); }
  [[nodiscard]] std::vector<std::byte> take() { return std::move(file_); }

 private:
  std::vector<std::byte> file_;
  PngTrouble trouble_{};
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

template <class Pixel>
Expected<std::vector<std::byte>> encode(const Image<Pixel>& image, int depth, int color_type) {
  PngEncoder encoder;
  if (!encoder.encode(image, depth, color_type)) return output_error(encoder.message());
  return encoder.take();
}

}  // namespace

Expected<std::vector<std::byte>> encode_png(const GrayImage8& image) {
  return encode(image, 8, PNG_COLOR_TYPE_GRAY);
}

Expected<std::vector<std::byte>> encode_png(const GrayImage16& image) {
  return encode(image, 16, PNG_COLOR_TYPE_GRAY);
}

Expected<std::vector<std::byte>> encode_png(const ColorImage8& image) {
  return encode(image, 8, PNG_COLOR_TYPE_RGB);
}

}  // namespace bodyscan
