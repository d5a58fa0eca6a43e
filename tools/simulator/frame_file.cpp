#include "tools/simulator/frame_file.hpp"

#include <vector>

namespace bodyscan::simulator {

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
