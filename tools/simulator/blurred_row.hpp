#pragma once

#include <cstddef>
#include <vector>

namespace bodyscan::simulator {

// A row (or column) of projector pixels as light: boxes of one pixel with hard edges half way between pixel
// centres, convolved exactly with a Gaussian. Tabulated 32 times a pixel and interpolated linearly (error
// below 2e-4 from 0.5 px of blur on). Beyond the picture's edge the outermost pixel goes on.
class BlurredRow {
 public:
  // `defocus` blurs all light; `scattered` (>= defocus) is the blur of the light that scattered under the
  // skin. Projector px, standard deviations.
  BlurredRow(const std::vector<float>& pixels, double defocus, double scattered);

  struct Value {
    float focused;
    float scatter_change;  // what scattered light has more
  };
  // From 2 px before the first pixel's centre to 2 px behind the last one's.
  [[nodiscard]] Value at(float coordinate) const {
    const float position = (coordinate + margin) * samples_per_px;
    const auto index = static_cast<std::size_t>(position);
    const float t = position - static_cast<float>(index);
    const Value& a = table_[index];
    const Value& b = table_[index + 1];
    return {a.focused + t * (b.focused - a.focused),
            a.scatter_change + t * (b.scatter_change - a.scatter_change)};
  }

 private:
  static constexpr float samples_per_px = 32;
  static constexpr float margin = 2;  // px before the first pixel's centre

  std::vector<Value> table_;
};

}  // namespace bodyscan::simulator
