#include "tests/pipeline/image/image_fixtures.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <jpeglib.h>
#include <png.h>
#include <zlib.h>

namespace bodyscan {
namespace {

// libjpeg's own error handler ends the test program, which is what a broken fixture deserves.
std::vector<std::byte> compress(Size size, int components, J_COLOR_SPACE space, const std::uint8_t* pixels,
                                const JpegOptions& options) {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors{};
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* buffer = nullptr;
  unsigned long length = 0;
  jpeg_mem_dest(&info, &buffer, &length);
  info.image_width = static_cast<JDIMENSION>(size.width);
  info.image_height = static_cast<JDIMENSION>(size.height);
  info.input_components = components;
  info.in_color_space = space;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, options.quality, TRUE);
  info.comp_info[0].h_samp_factor = options.chroma_step_x;
  info.comp_info[0].v_samp_factor = options.chroma_step_y;
  if (options.progressive) jpeg_simple_progression(&info);
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    const std::size_t offset = std::size_t{info.next_scanline} * info.image_width * components;
    JSAMPROW row = const_cast<JSAMPROW>(pixels + offset);
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  const auto* bytes = reinterpret_cast<const std::byte*>(buffer);
  std::vector<std::byte> file(bytes, bytes + length);
  std::free(buffer);
  return file;
}

void put_big_endian(std::byte* target, std::uint32_t value, int count) {
  for (int i = 0; i < count; ++i) target[i] = static_cast<std::byte>(value >> (8 * (count - 1 - i)));
}

void append_to(png_structp png, png_bytep source, std::size_t count) {
  auto* file = static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
  const auto* bytes = reinterpret_cast<const std::byte*>(source);
  file->insert(file->end(), bytes, bytes + count);
}

}  // namespace

std::vector<std::byte> make_jpeg(const ColorImage8& image, const JpegOptions& options) {
  return compress(image.size(), 3, JCS_RGB, image.data()->data(), options);
}

std::vector<std::byte> make_gray_jpeg(const GrayImage8& image) {
  return compress(image.size(), 1, JCS_GRAYSCALE, image.data(), {});
}

std::vector<std::byte> make_cmyk_jpeg(Size size) {
  const std::vector<std::uint8_t> pixels(size.area() * 4, 100);
  return compress(size, 4, JCS_CMYK, pixels.data(), {});
}

std::vector<std::byte> jpeg_claiming(std::vector<std::byte> file, Size size) {
  for (std::size_t at = 2; at + 9 < file.size();) {
    const auto marker = std::to_integer<int>(file[at + 1]);
    if (marker == 0xc0 || marker == 0xc2) {
      put_big_endian(&file[at + 5], static_cast<std::uint32_t>(size.height), 2);
      put_big_endian(&file[at + 7], static_cast<std::uint32_t>(size.width), 2);
      return file;
    }
    at += 2 + (std::to_integer<std::size_t>(file[at + 2]) << 8) + std::to_integer<std::size_t>(file[at + 3]);
  }
  std::abort();
}

std::vector<std::byte> png_claiming(std::vector<std::byte> file, std::uint32_t width, std::uint32_t height) {
  put_big_endian(&file[16], width, 4);
  put_big_endian(&file[20], height, 4);
  const auto crc = crc32(0, reinterpret_cast<const Bytef*>(&file[12]), 17);
  put_big_endian(&file[29], static_cast<std::uint32_t>(crc), 4);
  return file;
}

std::vector<std::byte> make_png(Size size, const PngOptions& options, std::span<const std::uint8_t> samples) {
  std::vector<std::byte> file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &file, append_to, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(size.width), static_cast<png_uint_32>(size.height),
               options.depth, options.color_type,
               options.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  std::array<png_color, 256> palette;
  for (int i = 0; i < 256; ++i)
    palette[static_cast<std::size_t>(i)] = {static_cast<png_byte>(2 * i), static_cast<png_byte>(255 - i),
                                            static_cast<png_byte>(i / 2)};
  if (options.color_type == PNG_COLOR_TYPE_PALETTE)
    png_set_PLTE(png, info, palette.data(), 1 << options.depth);
  if (options.gamma > 0) png_set_gAMA(png, info, options.gamma);
  png_write_info(png, info);
  const std::size_t stride = png_get_rowbytes(png, info);
  const int passes = options.interlaced ? png_set_interlace_handling(png) : 1;
  for (int pass = 0; pass < passes; ++pass)
    for (std::size_t y = 0; y < static_cast<std::size_t>(size.height); ++y)
      png_write_row(png, samples.data() + y * stride);
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return file;
}

ColorImage8 colorful(Size size) {
  ColorImage8 image(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      image(x, y) = {static_cast<std::uint8_t>(40 + 160 * x / size.width),
                     static_cast<std::uint8_t>(200 - 150 * y / size.height),
                     static_cast<std::uint8_t>(60 + 90 * (x + y) / (size.width + size.height))};
  return image;
}

}  // namespace bodyscan
