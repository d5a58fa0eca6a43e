#pragma once

#include "pipeline/model/mesh.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <stdlib.h>

namespace bodyscan {

// A folder of its own, gone with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "bodyscan_XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }

  [[nodiscard]] std::filesystem::path operator/(const char* name) const { return path_ / name; }
  [[nodiscard]] bool empty() const { return std::filesystem::is_empty(path_); }

 private:
  std::filesystem::path path_;
};

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A coloured relief of width x height points about 1 m away, in steps of 0.0001 mm.
inline Mesh relief(std::uint32_t width, std::uint32_t height) {
  Mesh mesh;
  const auto rounded = [](double mm) { return static_cast<float>(std::round(mm * 1e4) / 1e4); };
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const double depth = 1000 + 40 * std::sin(0.1 * x) * std::cos(0.07 * y);
      mesh.points.push_back({rounded((x - 0.5 * width) * depth / 1234),
                             rounded((y - 0.5 * height) * depth / 1234), rounded(depth)});
      mesh.colors.push_back(
          {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), static_cast<std::uint8_t>(x * y)});
    }
  }
  for (std::uint32_t y = 0; y + 1 < height; ++y) {
    for (std::uint32_t x = 0; x + 1 < width; ++x) {
      const std::uint32_t corner = y * width + x;
      mesh.faces.push_back({corner, corner + width, corner + 1});
      mesh.faces.push_back({corner + 1, corner + width, corner + width + 1});
    }
  }
  return mesh;
}

}  // namespace bodyscan
