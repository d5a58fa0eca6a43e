#include "pipeline/image/jpeg_decoder.hpp"

#include "pipeline/image/size_check.hpp"

#include <array>
#include <csetjmp>
#include <cstdio>
#include <string>

#include <jpeglib.h>

namespace bodyscan::detail {
namespace {

// libjpeg reports trouble by calling back; it must not return, and C++ exceptions must not cross its C
// frames.
struct JpegTrouble {
  jpeg_error_mgr manager;  // first: libjpeg hands back a pointer to it
  std::jmp_buf escape;
  std::array<char, JMSG_LENGTH_MAX> message;
};

[[noreturn]] void give_up(j_common_ptr info) {
  auto* trouble = reinterpret_cast<JpegTrouble*>(info->err);
  trouble->manager.format_message(info, trouble->message.data());
  std::longjmp(trouble->escape, 1);
}

void on_message(j_common_ptr info, int level) {
  if (level < 0) give_up(info);  // a warning: the data are damaged; anything above is a trace
}

void say_nothing(j_common_ptr) {}

struct JpegScanLimit {
  jpeg_progress_mgr manager;  // first: libjpeg hands back a pointer to it
  int max_scans;
};

void on_progress(j_common_ptr info) {
  const auto* limit = reinterpret_cast<const JpegScanLimit*>(info->progress);
  if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number <= limit->max_scans) return;
  auto* trouble = reinterpret_cast<JpegTrouble*>(info->err);
  std::snprintf(trouble->message.data(), trouble->message.size(), "more than %d scans", limit->max_scans);
  std::longjmp(trouble->escape, 1);
}

// One file being decompressed. Every call into libjpeg happens in a member function that sets the point of
// return and holds no object with a destructor.
class JpegDecoder {
 public:
  JpegDecoder(std::span<const std::byte> file, const ImageLimits& limits) : file_(file) {
    info_.err = jpeg_std_error(&trouble_.manager);
    trouble_.manager.error_exit = give_up;
    trouble_.manager.emit_message = on_message;
    trouble_.manager.output_message = say_nothing;
    scans_.manager.progress_monitor = on_progress;
    scans_.max_scans = limits.max_jpeg_scans;
  }
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;
  ~JpegDecoder() { jpeg_destroy_decompress(&info_); }

  [[nodiscard]] bool read_header() {
    if (setjmp(trouble_.escape) != 0) return false;
    jpeg_create_decompress(&info_);
    info_.progress = &scans_.manager;
    jpeg_mem_src(&info_, reinterpret_cast<const unsigned char*>(file_.data()), file_.size());
    jpeg_read_header(&info_, TRUE);
    return true;
  }

  // `pixels` has room for the header's size in the colour space's number of bytes a pixel.
  [[nodiscard]] bool decode(J_COLOR_SPACE space, std::uint8_t* pixels) {
    if (setjmp(trouble_.escape) != 0) return false;
    info_.out_color_space = space;
    jpeg_start_decompress(&info_);
    const std::size_t row_bytes = std::size_t{info_.output_width} * info_.output_components;
    while (info_.output_scanline < info_.output_height) {
      JSAMPROW row = pixels + info_.output_scanline * row_bytes;
      jpeg_read_scanlines(&info_, &row, 1);
    }
    jpeg_finish_decompress(&info_);
    return true;
  }

  [[nodiscard]] std::uint32_t width() const { return info_.image_width; }
  [[nodiscard]] std::uint32_t height() const { return info_.image_height; }
  [[nodiscard]] std::string message() const {
    return std::string("damaged JPEG: ") + trouble_.message.data();
  }

 private:
  std::span<const std::byte> file_;
  JpegTrouble trouble_{};
  JpegScanLimit scans_{};
  jpeg_decompress_struct info_{};
};

Expected<Size> header_size(JpegDecoder& decoder, const ImageLimits& limits) {
  if (!decoder.read_header()) return input_error(decoder.message());
  return checked_size(decoder.width(), decoder.height(), limits);
}

}  // namespace

bool is_jpeg(std::span<const std::byte> file) {
  return file.size() >= 3 && file[0] == std::byte{0xff} && file[1] == std::byte{0xd8} &&
         file[2] == std::byte{0xff};
}

Expected<Size> jpeg_size(std::span<const std::byte> file, const ImageLimits& limits) {
  JpegDecoder decoder(file, limits);
  return header_size(decoder, limits);
}

Expected<void> decode_jpeg_luma(std::span<const std::byte> file, const ImageLimits& limits, Luma& luma) {
  JpegDecoder decoder(file, limits);
  const Expected<Size> size = header_size(decoder, limits);
  if (!size) return tl::unexpected(size.error());
  GrayImage8& image = reuse<std::uint8_t>(luma, *size);
  if (!decoder.decode(JCS_GRAYSCALE, image.data())) return input_error(decoder.message());
  return {};
}

Expected<ColorImage8> decode_jpeg_color(std::span<const std::byte> file, const ImageLimits& limits) {
  JpegDecoder decoder(file, limits);
  const Expected<Size> size = header_size(decoder, limits);
  if (!size) return tl::unexpected(size.error());
  ColorImage8 image(*size);
  if (!decoder.decode(JCS_RGB, image.data()->data())) return input_error(decoder.message());
  return image;
}

}  // namespace bodyscan::detail
