#include "tools/simulator/image_files.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <png.h>
#include <turbojpeg.h>

namespace bodyscan::simulator {
namespace {

constexpr std::size_t max_pixels = std::size_t{1} << 28;

struct CloseTurboJpeg {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using TurboJpeg = std::unique_ptr<void, CloseTurboJpeg>;

Expected<ColorImage8> decode_jpeg(const std::vector<std::uint8_t>& bytes) {
  const TurboJpeg decoder(tjInitDecompress());
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int space = 0;
  if (!decoder || tjDecompressHeader3(decoder.get(), bytes.data(), bytes.size(), &width, &height,
                                      &subsampling, &space) != 0)
    return input_error("not a readable JPEG");
  const Size size{width, height};
  if (size.area() > max_pixels) return input_error("too large");
  ColorImage8 image(size);
  if (tjDecompress2(decoder.get(), bytes.data(), bytes.size(), image.data()->data(), width, 0, height,
                    TJPF_RGB, TJFLAG_ACCURATEDCT) != 0)
    return input_error(tjGetErrorStr2(decoder.get()));
  return image;
}

Expected<ColorImage8> decode_png(const std::vector<std::uint8_t>& bytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0)
    return input_error(png.message);
  const Size size{static_cast<int>(png.width), static_cast<int>(png.height)};
  png.format = PNG_FORMAT_RGB;
  const png_color black{};
  const bool fits = size.area() <= max_pixels;
  ColorImage8 image(fits ? size : Size{});
  const bool read = fits && png_image_finish_read(&png, &black, image.data(), 0, nullptr) != 0;
  const std::string problem = fits ? png.message : "too large";
  png_image_free(&png);
  if (!read) return input_error(problem);
  return image;
}

template <class Pixel>
Expected<void> write_png_as(const std::filesystem::path& path, const Image<Pixel>& image,
                            png_uint_32 format) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width());
  png.height = static_cast<png_uint_32>(image.height());
  png.format = format;
  png.flags = PNG_IMAGE_FLAG_FAST;
  if (png_image_write_to_file(&png, path.c_str(), 0, image.data(), 0, nullptr) == 0)
    return output_error(path.string() + ": " + png.message);
  return {};
}

template <class Pixel>
Expected<void> write_pfm_as(const std::filesystem::path& path, const Image<Pixel>& image, const char* magic) {
  std::ofstream file(path, std::ios::binary);
  file << magic << '\n' << image.width() << ' ' << image.height() << "\n-1.0\n";
  for (int y = image.height() - 1; y >= 0; --y)
    file.write(reinterpret_cast<const char*>(image.row(y)),
               static_cast<std::streamsize>(image.width() * sizeof(Pixel)));
  file.close();
  if (!file) return output_error(path.string() + ": " + std::strerror(errno));
  return {};
}

}  // namespace

Expected<ColorImage8> read_color_image(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file),
                                        std::istreambuf_iterator<char>()};
  if (bytes.empty()) return input_error(path.string() + ": cannot be read");
  const bool jpeg = bytes.size() > 1 && bytes[0] == 0xFF && bytes[1] == 0xD8;
  Expected<ColorImage8> image = jpeg ? decode_jpeg(bytes) : decode_png(bytes);
  if (!image) return tl::unexpected(image.error().within(path.string()));
  return image;
}

Expected<std::vector<std::uint8_t>> encode_jpeg(const ColorImage8& image, int quality) {
  const TurboJpeg encoder(tjInitCompress());
  if (!encoder) return output_error("JPEG: no encoder");
  std::vector<std::uint8_t> bytes(tjBufSize(image.width(), image.height(), TJSAMP_422));
  std::uint8_t* data = bytes.data();
  unsigned long size = bytes.size();
  if (tjCompress2(encoder.get(), image.data()->data(), image.width(), 0, image.height(), TJPF_RGB, &data,
                  &size, TJSAMP_422, quality, TJFLAG_ACCURATEDCT | TJFLAG_NOREALLOC) != 0)
    return output_error(std::string("JPEG: ") + tjGetErrorStr2(encoder.get()));
  bytes.resize(size);
  return bytes;
}

Expected<void> write_png(const std::filesystem::path& path, const ColorImage8& image) {
  return write_png_as(path, image, PNG_FORMAT_RGB);
}

Expected<void> write_png(const std::filesystem::path& path, const GrayImage8& image) {
  return write_png_as(path, image, PNG_FORMAT_GRAY);
}

Expected<void> write_pfm(const std::filesystem::path& path, const FloatImage& image) {
  return write_pfm_as(path, image, "Pf");
}

Expected<void> write_pfm(const std::filesystem::path& path, const Image<Eigen::Vector3f>& image) {
  return write_pfm_as(path, image, "PF");
}

Expected<void> write_bytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) return output_error(path.string() + ": " + std::strerror(errno));
  return {};
}

}  // namespace bodyscan::simulator
