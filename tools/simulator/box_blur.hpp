#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace bodyscan::simulator {

// Pixels of light as boxes with hard edges half way between pixel centres, convolved exactly with a Gaussian
// and sampled `samples` times a pixel, from `margin` px before the first pixel's centre to as far behind the
// last one's. Beyond the first and the last pixel these go on.
class BoxBlur {
 public:
  // `sigma`: the Gaussian's standard deviation, px; 0 leaves the boxes.
  BoxBlur(double sigma, int samples, int margin);

  // Samples of a row of this many pixels.
  [[nodiscard]] int count(int pixels) const { return (pixels + 2 * margin_) * samples_ + 1; }
  [[nodiscard]] std::vector<float> blur(std::span<const float> pixels) const;

  // A sample is the sum of these weights over the pixels from first_pixel on.
  [[nodiscard]] std::span<const double> weights(int sample) const {
    return {&weights_[static_cast<std::size_t>(sample % samples_ * taps_)], static_cast<std::size_t>(taps_)};
  }
  [[nodiscard]] int first_pixel(int sample) const { return sample / samples_ - margin_ - taps_ / 2; }

 private:
  int samples_;
  int margin_;
  int taps_;
  std::vector<double> weights_;
};

}  // namespace bodyscan::simulator
