#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"

#include <filesystem>
#include <span>

#include <Eigen/Core>

namespace bodyscan::simulator {

// JPEG or PNG, by the file's first bytes; at most 2^28 pixels.
Expected<ColorImage8> read_color_image(const std::filesystem::path& path);

// Colour in 4:2:2, as a camera writes it.
Expected<std::vector<std::uint8_t>> encode_jpeg(const ColorImage8& image, int quality);
Expected<void> write_png(const std::filesystem::path& path, const ColorImage8& image);
Expected<void> write_png(const std::filesystem::path& path, const GrayImage8& image);
// Portable float map: little-endian floats, the bottom row first.
Expected<void> write_pfm(const std::filesystem::path& path, const FloatImage& image);
Expected<void> write_pfm(const std::filesystem::path& path, const Image<Eigen::Vector3f>& image);
Expected<void> write_bytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace bodyscan::simulator
