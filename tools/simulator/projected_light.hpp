#pragma once

#include "pipeline/pattern/sequence.hpp"

#include <array>
#include <vector>

namespace bodyscan::simulator {

// The light of one projected picture along the axis in which it changes, as a share of white's: boxes of one
// projector pixel with hard edges half way between pixel centres, convolved exactly with a Gaussian.
// Tabulated 32 times a pixel and interpolated linearly (error below 2e-4 from 0.5 px of blur on). Beyond the
// picture's edge the outermost pixel goes on.
class ProjectedLight {
 public:
  // `defocus` blurs all light; `scattered` (>= defocus) is the blur of the light that scattered under the
  // skin.
  ProjectedLight(const Pattern& pattern, Size projector, double defocus, double scattered);

  struct Value {
    float focused;
    float scatter_change;  // what scattered light has more
  };
  [[nodiscard]] Value at(float coordinate) const {
    const float position = (coordinate + margin) * samples_per_px;
    const auto index = static_cast<std::size_t>(position);
    const float t = position - static_cast<float>(index);
    const Value& a = table_[index];
    const Value& b = table_[index + 1];
    return {a.focused + t * (b.focused - a.focused),
            a.scatter_change + t * (b.scatter_change - a.scatter_change)};
  }
  // Mean over the picture, 0..1.
  [[nodiscard]] float mean() const { return mean_; }
  [[nodiscard]] Axis axis() const { return axis_; }

 private:
  static constexpr float samples_per_px = 32;
  static constexpr float margin = 2;  // px before the first pixel's centre

  std::vector<Value> table_;
  float mean_ = 0;
  Axis axis_;
};

}  // namespace bodyscan::simulator
