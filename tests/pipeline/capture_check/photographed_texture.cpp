#include "tests/pipeline/capture_check/photographed_texture.hpp"

#include "pipeline/image/srgb.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace bodyscan {

FloatImage texture(const Eigen::Vector2d& moved, Size size) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  struct Wave {
    Eigen::Vector2d frequency;
    double phase;
  };
  std::vector<Wave> waves(12);
  for (Wave& wave : waves) {
    const double frequency = 2 * std::numbers::pi / (16 + 44 * share(random));
    const double angle = std::numbers::pi * share(random);
    wave = {frequency * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
            2 * std::numbers::pi * share(random)};
  }
  FloatImage image(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      double sum = 0;
      for (const Wave& wave : waves)
        sum += std::cos(wave.frequency.dot(Eigen::Vector2d(x, y) - moved) + wave.phase);
      image(x, y) = static_cast<float>(std::clamp(0.5 + 0.1 * sum, 0.2, 0.8));
    }
  }
  return image;
}

const FloatImage& texture_at_rest() {
  static const FloatImage still = texture();
  return still;
}

GrayImage8 TexturedWall::shoot(const Pattern& pattern, const ShotOptions& options) {
  static const std::vector<float> encoded = [] {
    std::vector<float> table(4096);
    for (std::size_t i = 0; i < table.size(); ++i)
      table[i] = static_cast<float>(255 * linear_to_srgb(static_cast<double>(i) / 4095));
    return table;
  }();
  std::normal_distribution<float> noise(0, static_cast<float>(std::max(options.noise, 1e-9)));
  const GrayImage8 shown = render_pattern(pattern, projector);
  const bool even = pattern.kind == PatternKind::gray && pattern.bit < options.blurred_bits;
  GrayImage8 photograph(texture_size);
  for (int y = 0; y < texture_size.height; ++y) {
    for (int x = 0; x < texture_size.width; ++x) {
      const int column = x * projector.width / texture_size.width;
      const int row = y * projector.height / texture_size.height;
      const double lit = even ? 0.5 : shown(column, row) / 255.0;
      const double light = options.ambient + 0.8 * options.projector * lit * albedo_(x, y);
      const double value = std::clamp(options.exposure * light, 0.0, 1.0);
      const float level = encoded[static_cast<std::size_t>(value * 4095)] + noise(random_);
      photograph(x, y) = static_cast<std::uint8_t>(std::clamp(std::lround(level), 0L, 255L));
    }
  }
  return photograph;
}

std::vector<Pattern> patterns_of_wall(bool inverses) {
  std::vector<Pattern> patterns =
      make_sequence(TexturedWall::projector, {.columns = true, .inverses = inverses}).value().patterns;
  patterns.push_back({.kind = PatternKind::white});
  return patterns;
}

}  // namespace bodyscan
