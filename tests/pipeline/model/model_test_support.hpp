#pragma once

#include "pipeline/model/mesh.hpp"

#include <cmath>

namespace bodyscan {

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
