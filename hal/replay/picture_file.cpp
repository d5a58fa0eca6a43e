#include "hal/replay/picture_file.hpp"

#include "pipeline/base/read_file.hpp"

namespace bodyscan {

Expected<Size> declared_size(const std::filesystem::path& path, const ImageLimits& limits) {
  constexpr std::size_t usual_header = 64 << 10;
  Expected<std::vector<std::byte>> file = read_file_start(path, usual_header);
  if (!file) return tl::unexpected(file.error());
  Expected<Size> size = read_size(*file, limits);
  if (!size && file->size() == usual_header) {  // long metadata in front of the header
    file = read_file(path, limits.max_file_bytes);
    if (!file) return tl::unexpected(file.error());
    size = read_size(*file, limits);
  }
  return size.map_error([&](const Error& error) { return error.within(path.string()); });
}

Expected<Luma> load_luma(const std::filesystem::path& path, const ImageLimits& limits) {
  const Expected<std::vector<std::byte>> file = read_file(path, limits.max_file_bytes);
  if (!file) return tl::unexpected(file.error());
  return decode_luma(*file, limits).map_error([&](const Error& error) {
    return error.within(path.string());
  });
}

}  // namespace bodyscan
