#include "tools/simulator/frame_file.hpp"

#include <vector>

namespace bodyscan::simulator {

Expected<void> make_folder(const std::filesystem::path& folder) {
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  if (problem) return output_error(folder.string() + ": " + problem.message());
  return {};
}

std::string extension(FrameFormat format) {
  return format == FrameFormat::jpeg ? ".jpg" : ".png";
}

Expected<void> write_frame(const std::filesystem::path& path, const ColorImage8& image,
                           const RenderOptions& options) {
  if (options.format == FrameFormat::png) return write_png(path, image);
  const Expected<std::vector<std::uint8_t>> jpeg = encode_jpeg(image, options.jpeg_quality);
  if (!jpeg) return tl::unexpected(jpeg.error().within(path.string()));
  return write_bytes(path, *jpeg);
}

}  // namespace bodyscan::simulator
