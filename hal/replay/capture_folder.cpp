#include "hal/replay/capture_folder.hpp"

#include "pipeline/base/read_file.hpp"
#include "pipeline/base/size_text.hpp"

#include <string>
#include <utility>

namespace bodyscan {
namespace {

// Decode order starts with these two.
constexpr int white_index = 0;
constexpr int black_index = 1;

}  // namespace

Expected<CaptureFolder> CaptureFolder::open(const std::filesystem::path& folder, const ImageLimits& limits) {
  const std::filesystem::path manifest_path = folder / "capture.json";
  const Expected<std::vector<std::byte>> text = read_file(manifest_path, max_manifest_bytes);
  if (!text) return tl::unexpected(text.error());
  Expected<CaptureManifest> manifest = parse_manifest(as_text(*text), manifest_path.string());
  if (!manifest) return tl::unexpected(manifest.error());

  CaptureFolder capture(folder, std::move(*manifest), limits);
  for (int i = 0; i < capture.frame_count(); ++i) {
    const Expected<Size> size = capture.declared_size(i);
    if (!size) return tl::unexpected(size.error());
    if (i == 0) capture.size_ = *size;
    if (Expected<void> same = capture.check_size(i, *size); !same) return tl::unexpected(same.error());
  }
  return capture;
}

Expected<Frame> CaptureFolder::load(int index) const {
  Frame frame;
  std::vector<std::byte> file;
  if (Expected<void> loaded = load_into(index, frame, file); !loaded) return tl::unexpected(loaded.error());
  return frame;
}

Expected<void> CaptureFolder::load_into(int index, Frame& frame, std::vector<std::byte>& file_buffer) const {
  const std::filesystem::path path = path_of(index);
  if (Expected<void> read = read_file_into(path, limits_.max_file_bytes, file_buffer); !read) return read;
  if (Expected<void> decoded = decode_luma_into(file_buffer, frame.luma, limits_); !decoded)
    return tl::unexpected(decoded.error().within(path.string()));
  frame.pattern = manifest_.frames[static_cast<std::size_t>(index)].pattern;
  return check_size(index, size_of(frame.luma));
}

Expected<ColorImage8> CaptureFolder::load_white_color() const {
  return load_color(white_index);
}

Expected<ColorImage8> CaptureFolder::load_black_color() const {
  return load_color(black_index);
}

Expected<ColorImage8> CaptureFolder::load_color(int index) const {
  const std::filesystem::path path = path_of(index);
  const Expected<std::vector<std::byte>> file = read_file(path, limits_.max_file_bytes);
  if (!file) return tl::unexpected(file.error());
  Expected<ColorImage8> image = decode_color(*file, limits_);
  if (!image) return tl::unexpected(image.error().within(path.string()));
  if (Expected<void> same = check_size(index, image->size()); !same) return tl::unexpected(same.error());
  return image;
}

std::vector<std::filesystem::path> CaptureFolder::files() const {
  std::vector<std::filesystem::path> files{folder_ / "capture.json"};
  for (int i = 0; i < frame_count(); ++i) files.push_back(path_of(i));
  return files;
}

std::filesystem::path CaptureFolder::path_of(int index) const {
  return folder_ / manifest_.frames[static_cast<std::size_t>(index)].file;
}

Expected<Size> CaptureFolder::declared_size(int index) const {
  constexpr std::size_t usual_header = 64 << 10;
  const std::filesystem::path path = path_of(index);
  Expected<std::vector<std::byte>> file = read_file_start(path, usual_header);
  if (!file) return tl::unexpected(file.error());
  Expected<Size> size = read_size(*file, limits_);
  if (!size && file->size() == usual_header) {  // long metadata in front of the header
    file = read_file(path, limits_.max_file_bytes);
    if (!file) return tl::unexpected(file.error());
    size = read_size(*file, limits_);
  }
  return size.map_error([&](const Error& error) { return error.within(path.string()); });
}

Expected<void> CaptureFolder::check_size(int index, Size size) const {
  if (size == size_) return {};
  return input_error(path_of(index).string() + ": " + text_of(size) + " pixels, while " +
                     path_of(white_index).string() + " has " + text_of(size_));
}

}  // namespace bodyscan
