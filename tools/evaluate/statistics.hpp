#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace bodyscan {

// What a set of signed deviations looks like; all zero for an empty set. Lengths are those of the input.
struct Statistics {
  std::size_t count = 0;
  double rms = 0;
  double bias = 0;  // mean, signed
  double mad = 0;   // median absolute deviation from the median, not scaled
  double p50 = 0;   // percentiles of the absolute deviation
  double p95 = 0;
  double p997 = 0;
  double range_997 =
      0;  // width of the interval that leaves out 0.15 % at either end (VDI/VDE 2634-2's "form")
};

Statistics summarize(std::span<const float> signed_deviations);

// The value below which the share `fraction` (0..1) lies, linearly interpolated; reorders `values`. 0 if
// empty.
double quantile(std::vector<float>& values, double fraction);

}  // namespace bodyscan
