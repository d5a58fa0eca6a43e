#include "pipeline/image/png_decoder.hpp"

#include "pipeline/image/size_check.hpp"

#include <array>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include <png.h>

namespace bodyscan::detail {
namespace {

// libpng's callbacks must not return after an error, and C++ exceptions must not cross its C frames.
struct PngTrouble {
  std::jmp_buf escape;
  std::array<char, 160> message;
};

[[noreturn]] void give_up(png_structp png, png_const_charp message) {
  auto* trouble = static_cast<PngTrouble*>(png_get_error_ptr(png));
  std::snprintf(trouble->message.data(), trouble->message.size(), "%s", message);
  std::longjmp(trouble->escape, 1);
}

void ignore_warning(png_structp, png_const_charp) {}  // oddities in chunks that hold no pixels

void read_bytes(png_structp png, png_bytep target, std::size_t count) {
  auto* rest = static_cast<std::span<const std::byte>*>(png_get_io_ptr(png));
  if (count > rest->size()) png_error(png, "the file ends early");
  std::memcpy(target, rest->data(), count);
  *rest = rest->subspan(count);
}

enum class Output { luma, color };

// One file being decompressed. Every call into libpng happens in a member function that sets the point of
// return and holds no object with a destructor.
class PngDecoder {
 public:
  explicit PngDecoder(std::span<const std::byte> file) : rest_(file) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &trouble_, give_up, ignore_warning);
    if (png_ == nullptr) return;
    info_ = png_create_info_struct(png_);
    png_set_read_fn(png_, &rest_, read_bytes);
    // Sizes are checked after the header; libpng's own limit on a chunk's memory (8 MB) stays.
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  }
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;
  ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }

  [[nodiscard]] bool read_header() {
    if (png_ == nullptr || info_ == nullptr) return false;
    if (setjmp(trouble_.escape) != 0) return false;
    png_read_info(png_, info_);
    return true;
  }

  // Afterwards rows are grey or RGB, 8 or 16 bits a sample in this machine's byte order.
  [[nodiscard]] bool set_up(Output output) {
    if (setjmp(trouble_.escape) != 0) return false;
    const int type = png_get_color_type(png_, info_);
    if (type == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png_);
    if (type == PNG_COLOR_TYPE_GRAY) png_set_expand_gray_1_2_4_to_8(png_);
    if ((type & PNG_COLOR_MASK_ALPHA) != 0) png_set_strip_alpha(png_);
    if (output == Output::color) {
      if ((type & PNG_COLOR_MASK_COLOR) == 0) png_set_gray_to_rgb(png_);
      png_set_scale_16(png_);
    } else if constexpr (std::endian::native == std::endian::little) {
      png_set_swap(png_);
    }
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }

  // Every pass over the rows; take(y, row) gets each row once, complete, and must not throw. `buffer` holds
  // one row, or all of them where the file is interlaced.
  template <class Take>
  [[nodiscard]] bool read_rows(png_bytep buffer, Take take) {
    if (setjmp(trouble_.escape) != 0) return false;
    const std::size_t stride = interlaced() ? row_bytes() : 0;
    for (int pass = 0; pass < passes_; ++pass) {
      for (png_uint_32 y = 0; y < height(); ++y) {
        png_read_row(png_, buffer + y * stride, nullptr);
        if (pass + 1 == passes_) take(static_cast<int>(y), buffer + y * stride);
      }
    }
    png_read_end(png_, nullptr);
    return true;
  }

  [[nodiscard]] bool interlaced() const { return passes_ > 1; }
  [[nodiscard]] std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }
  [[nodiscard]] bool wide() const { return png_get_bit_depth(png_, info_) == 16; }
  [[nodiscard]] bool colored() const { return png_get_channels(png_, info_) == 3; }
  [[nodiscard]] png_uint_32 width() const { return png_get_image_width(png_, info_); }
  [[nodiscard]] png_uint_32 height() const { return png_get_image_height(png_, info_); }
  [[nodiscard]] std::string message() const { return std::string("damaged PNG: ") + trouble_.message.data(); }

 private:
  std::span<const std::byte> rest_;
  PngTrouble trouble_{};
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int passes_ = 1;
};

Expected<Size> header_size(PngDecoder& decoder, const ImageLimits& limits) {
  if (!decoder.read_header()) return input_error(decoder.message());
  return checked_size(decoder.width(), decoder.height(), limits);
}

// Header, limits and set-up; the buffer for read_rows.
Expected<std::unique_ptr<png_byte[]>> prepare(PngDecoder& decoder, const ImageLimits& limits, Output output,
                                              Size& size) {
  const Expected<Size> header = header_size(decoder, limits);
  if (!header) return tl::unexpected(header.error());
  if (!decoder.set_up(output)) return input_error(decoder.message());
  size = *header;
  const std::size_t rows = decoder.interlaced() ? decoder.height() : 1;
  return std::make_unique_for_overwrite<png_byte[]>(decoder.row_bytes() * rows);
}

// Samples of `row`, three a pixel if `colored`, to BT.601 luma in 16-bit fixed point.
template <class Sample>
void to_luma(const png_byte* row, bool colored, std::span<Sample> luma) {
  if (!colored) {
    std::memcpy(luma.data(), row, luma.size_bytes());
    return;
  }
  for (std::size_t x = 0; x < luma.size(); ++x) {
    std::array<Sample, 3> rgb;
    std::memcpy(rgb.data(), row + x * sizeof rgb, sizeof rgb);
    luma[x] = static_cast<Sample>((19595U * rgb[0] + 38470U * rgb[1] + 7471U * rgb[2] + 32768U) >> 16);
  }
}

template <class Sample>
bool read_luma(PngDecoder& decoder, png_bytep buffer, Image<Sample>& image) {
  const bool colored = decoder.colored();
  return decoder.read_rows(buffer, [&](int y, const png_byte* row) {
    to_luma<Sample>(row, colored, {image.row(y), static_cast<std::size_t>(image.width())});
  });
}

}  // namespace

bool is_png(std::span<const std::byte> file) {
  return file.size() >= 8 && png_sig_cmp(reinterpret_cast<png_const_bytep>(file.data()), 0, 8) == 0;
}

Expected<Size> png_size(std::span<const std::byte> file, const ImageLimits& limits) {
  PngDecoder decoder(file);
  return header_size(decoder, limits);
}

Expected<void> decode_png_luma(std::span<const std::byte> file, const ImageLimits& limits, Luma& luma) {
  PngDecoder decoder(file);
  Size size;
  const auto buffer = prepare(decoder, limits, Output::luma, size);
  if (!buffer) return tl::unexpected(buffer.error());
  const bool read = decoder.wide() ? read_luma(decoder, buffer->get(), reuse<std::uint16_t>(luma, size))
                                   : read_luma(decoder, buffer->get(), reuse<std::uint8_t>(luma, size));
  if (!read) return input_error(decoder.message());
  return {};
}

Expected<ColorImage8> decode_png_color(std::span<const std::byte> file, const ImageLimits& limits) {
  PngDecoder decoder(file);
  Size size;
  const auto buffer = prepare(decoder, limits, Output::color, size);
  if (!buffer) return tl::unexpected(buffer.error());
  ColorImage8 image(size);
  const bool read = decoder.read_rows(buffer->get(), [&](int y, const png_byte* row) {
    std::memcpy(image.row(y), row, static_cast<std::size_t>(image.width()) * sizeof(Rgb8));
  });
  if (!read) return input_error(decoder.message());
  return image;
}

}  // namespace bodyscan::detail
