#pragma once

#include <cstddef>
#include <optional>

namespace bodyscan {

// A square of measured values, 2 radius + 1 on a side; pointers to the one in the middle, strides in floats.
struct WeightedSquare {
  static constexpr int max_radius = 8;

  const float* value;
  std::ptrdiff_t value_stride;
  const float* weight;  // inverse variance; 0 where the value does not count
  std::ptrdiff_t weight_stride;
  int radius;  // 1 to max_radius
};

struct WeightedFit {
  float value;  // at the middle
  float sigma;
};

// Weighted least-squares quadratic in both directions through a square with gaps. Nothing where it holds too
// little, or too lopsided, to be better than the middle's own value, or where the values stray from the
// quadratic by more than their variances allow.
std::optional<WeightedFit> fit_weighted(const WeightedSquare& square);

}  // namespace bodyscan
