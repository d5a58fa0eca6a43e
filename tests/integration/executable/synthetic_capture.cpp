#include "synthetic_capture.hpp"

#include "hal/replay/capture_manifest.hpp"
#include "pipeline/calibration/calibration_file.hpp"
#include "pipeline/image/codec.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr Size projector_size{32, 24};
constexpr double wall_mm = 1000;

// The pattern at projector coordinate `position`, its edges blurred over 0.6 projector pixels.
double blurred(const Pattern& pattern, double position, int count) {
  if (pattern.kind == PatternKind::black) return 0;
  double sum = 0;
  constexpr int samples = 13;
  for (int i = 0; i < samples; ++i) {
    const double at = position + 0.6 * ((i + 0.5) / samples - 0.5);
    const int index = static_cast<int>(std::lround(at));
    if (index < 0 || index >= count) continue;
    if (pattern.kind == PatternKind::white || pattern_is_white(pattern, static_cast<unsigned>(index)))
      sum += 1.0 / samples;
  }
  return sum;
}

std::uint8_t encode_srgb(double light) {
  const double value = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

}  // namespace

Calibration small_calibration() {
  Calibration calibration;
  calibration.camera = {.size = {160, 120}, .fx = 175, .fy = 175, .cx = 79.5, .cy = 59.5, .distortion = {}};
  calibration.projector = {
      .size = projector_size, .fx = 34, .fy = 34, .cx = 15.5, .cy = 20.5, .distortion = {}};
  calibration.projector_from_camera.translation = {0, -270, 0};
  return calibration;
}

void write_photograph(const std::filesystem::path& path, const Pattern& pattern, Size camera) {
  const Calibration calibration = small_calibration();
  ColorImage8 photograph(camera);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector3d wall = calibration.camera.ray({x, y}) * wall_mm;
      const Eigen::Vector2d at = calibration.projector.project(calibration.projector_from_camera * wall);
      const bool inside = at.x() > -0.5 && at.x() < projector_size.width - 0.5;
      const double shown = pattern.axis == Axis::row ? blurred(pattern, at.y(), projector_size.height)
                                                     : blurred(pattern, at.x(), projector_size.width);
      const double light = 0.004 + (inside ? 0.6 * shown : 0);
      photograph(x, y) = {encode_srgb(light), encode_srgb(0.8 * light), encode_srgb(0.7 * light)};
    }
  }
  const auto file = encode_png(photograph);
  ASSERT_TRUE(file.has_value());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(file->data()), static_cast<std::streamsize>(file->size()));
}

void write_small_capture(const std::filesystem::path& folder) {
  const Calibration calibration = small_calibration();
  ASSERT_TRUE(write_calibration(calibration, folder / "calibration.yml").has_value());
  const auto sequence = make_sequence(projector_size);
  ASSERT_TRUE(sequence.has_value());
  CaptureManifest manifest;
  manifest.projector = projector_size;
  for (const Pattern& pattern : sequence->patterns) {
    const std::string number = std::to_string(manifest.frames.size());
    const std::string name = "frame_" + std::string(2 - number.size(), '0') + number + ".png";
    write_photograph(folder / name, pattern, calibration.camera.size);
    manifest.frames.push_back({name, pattern, {}});
  }
  ASSERT_TRUE(write_manifest(manifest, folder / "capture.json").has_value());
}

}  // namespace bodyscan
