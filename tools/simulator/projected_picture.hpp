#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/pattern/sequence.hpp"
#include "tools/simulator/blurred_row.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace bodyscan::simulator {

// The axis along which a picture changes if it changes along one only (row: from row to row); rows for a
// uniform picture.
std::optional<Axis> changing_axis(const FloatImage& picture);

// The pixels of a picture along the one axis in which it changes.
std::vector<float> pixels_along(const FloatImage& picture, Axis axis);

// The light of any projected picture as a share of white's: BlurredRow's model in both axes, tabulated 4
// times a pixel (twice where the blur exceeds 2 px) and interpolated bilinearly (error below 0.01 from 0.5 px
// of blur on).
class ProjectedPicture {
 public:
  // `picture`: linear light, 0 to 1. The blurs are BlurredRow's.
  ProjectedPicture(const FloatImage& picture, double defocus, double scattered);

  using Value = BlurredRow::Value;
  // From 2 px before the first pixel's centre to 2 px behind the last one's.
  [[nodiscard]] Value at(float column, float row) const {
    const float sharp = focused_.at(column, row);
    return {sharp, scattered_.samples.empty() ? 0 : scattered_.at(column, row) - sharp};
  }
  // Mean over the picture, 0..1.
  [[nodiscard]] float mean() const { return mean_; }

 private:
  struct Table {
    FloatImage samples;
    float samples_per_px = 0;

    [[nodiscard]] float at(float column, float row) const;
  };
  static Table tabulate(const FloatImage& picture, double sigma);

  static constexpr int margin = 2;  // px before the first pixel's centre

  Table focused_;
  Table scattered_;  // empty: as focused
  float mean_ = 0;
};

inline float ProjectedPicture::Table::at(float column, float row) const {
  const float x = (column + margin) * samples_per_px;
  const float y = (row + margin) * samples_per_px;
  const int left = static_cast<int>(x);
  const int top = static_cast<int>(y);
  const float tx = x - static_cast<float>(left);
  const float ty = y - static_cast<float>(top);
  const float* above = samples.row(top) + left;
  const float* below = samples.row(top + 1) + left;
  const float upper = above[0] + tx * (above[1] - above[0]);
  const float lower = below[0] + tx * (below[1] - below[0]);
  return upper + ty * (lower - upper);
}

}  // namespace bodyscan::simulator
