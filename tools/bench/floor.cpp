#include "tools/bench/floor.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

// jpeglib.h needs stdio's types before it.
#include <jpeglib.h>

namespace bodyscan {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> jpeg_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".jpg") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

// The files are the simulator's own: libjpeg's default handler, which ends the process on damage, will do.
void decompress(const fs::path& file, std::vector<JSAMPLE>& pixels) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), std::fclose);
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&jpeg);
  jpeg_stdio_src(&jpeg, stream.get());
  jpeg_read_header(&jpeg, TRUE);
  jpeg.out_color_space = JCS_GRAYSCALE;
  jpeg_start_decompress(&jpeg);
  pixels.resize(std::size_t{jpeg.output_width} * jpeg.output_height);
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPROW row = pixels.data() + std::size_t{jpeg.output_scanline} * jpeg.output_width;
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_decompress(&jpeg);
  jpeg_destroy_decompress(&jpeg);
}

void decompress_all(const std::vector<fs::path>& files) {
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    std::vector<JSAMPLE> pixels;
    for (std::size_t i = next++; i < files.size(); i = next++) decompress(files[i], pixels);
  };
  const std::jthread second(work);
  work();
}

Expected<void> write_bytes(const fs::path& output, std::size_t bytes) {
  const std::vector<char> block(std::size_t{4} << 20, '7');
  const int file = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) return output_error(output.string() + ": cannot be written");
  std::size_t written = 0;
  while (written < bytes) {
    const ssize_t count = write(file, block.data(), std::min(block.size(), bytes - written));
    if (count <= 0) break;
    written += static_cast<std::size_t>(count);
  }
  close(file);
  if (written < bytes) return output_error(output.string() + ": disk full");
  return {};
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Expected<Floor> measure_floor(const fs::path& capture, const fs::path& output, std::size_t output_bytes) {
  const std::vector<fs::path> files = jpeg_files(capture);
  if (files.empty()) return input_error(capture.string() + ": no JPEG files");
  Floor floor;
  auto start = std::chrono::steady_clock::now();
  decompress_all(files);
  floor.decompress_s = seconds_since(start);
  start = std::chrono::steady_clock::now();
  if (auto written = write_bytes(output, output_bytes); !written) return tl::unexpected(written.error());
  floor.write_s = seconds_since(start);
  return floor;
}

}  // namespace bodyscan
