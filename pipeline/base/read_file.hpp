#pragma once

#include "pipeline/base/error.hpp"

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

namespace bodyscan {

// The whole of a regular file; a file over `max_bytes` is an error. Messages name the
// file as given ("scan/capture.json: No such file or directory").
Expected<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::size_t max_bytes);

// The same into `bytes`, whose memory is used again.
Expected<void> read_file_into(const std::filesystem::path& path, std::size_t max_bytes,
                              std::vector<std::byte>& bytes);

// At most the first `count` bytes of a regular file.
Expected<std::vector<std::byte>> read_file_start(const std::filesystem::path& path, std::size_t count);

inline std::string_view as_text(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace bodyscan
