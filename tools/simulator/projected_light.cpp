#include "tools/simulator/projected_light.hpp"

namespace bodyscan::simulator {
namespace {

std::vector<float> pixels_of(const Pattern& pattern, Size projector) {
  const int length = pattern.axis == Axis::row ? projector.height : projector.width;
  std::vector<float> pixels(static_cast<std::size_t>(length),
                            pattern.kind == PatternKind::white ? 1.0F : 0.0F);
  if (pattern.kind == PatternKind::gray || pattern.kind == PatternKind::phase) {
    for (int i = 0; i < length; ++i)
      pixels[static_cast<std::size_t>(i)] = pattern_is_white(pattern, static_cast<unsigned>(i)) ? 1.0F : 0.0F;
  }
  return pixels;
}

}  // namespace

ProjectedLight::ProjectedLight(const Pattern& pattern, Size projector, double defocus, double scattered)
    : ProjectedLight(pixels_of(pattern, projector), pattern.axis, defocus, scattered) {}

ProjectedLight::ProjectedLight(const std::vector<float>& pixels, Axis axis, double defocus, double scattered)
    : row_(pixels, defocus, scattered), axis_(axis) {
  for (const float pixel : pixels) mean_ += pixel / static_cast<float>(pixels.size());
}

}  // namespace bodyscan::simulator
