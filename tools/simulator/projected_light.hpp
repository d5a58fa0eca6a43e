#pragma once

#include "pipeline/pattern/sequence.hpp"
#include "tools/simulator/blurred_row.hpp"

namespace bodyscan::simulator {

// The light of a projected picture along the one axis in which it changes, as a share of white's.
class ProjectedLight {
 public:
  // The blurs are BlurredRow's.
  ProjectedLight(const Pattern& pattern, Size projector, double defocus, double scattered);
  // `pixels`: linear light along the axis, 0 to 1.
  ProjectedLight(const std::vector<float>& pixels, Axis axis, double defocus, double scattered);

  using Value = BlurredRow::Value;
  [[nodiscard]] Value at(float coordinate) const { return row_.at(coordinate); }
  // Mean over the picture, 0..1.
  [[nodiscard]] float mean() const { return mean_; }
  [[nodiscard]] Axis axis() const { return axis_; }

 private:
  BlurredRow row_;
  float mean_ = 0;
  Axis axis_;
};

}  // namespace bodyscan::simulator
