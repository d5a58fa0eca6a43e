#pragma once

#include <cstddef>
#include <functional>

namespace bodyscan {

// `count` camera rows, the first at `first`, every `step`-th.
struct RowRange {
  int first;
  int count;
  int step = 1;

  [[nodiscard]] int camera_row(int i) const { return first + i * step; }
};

// Where their measurements go: a camera width of floats a row, rows `stride` floats apart.
struct RowArrays {
  float* coordinate;  // as in AxisCorrespondence
  float* sigma;
  std::ptrdiff_t stride;

  [[nodiscard]] float* coordinate_row(int i) const { return coordinate + i * stride; }
  [[nodiscard]] float* sigma_row(int i) const { return sigma + i * stride; }
};

// Measures camera rows of one axis on demand; called from several threads.
using CoordinateRows = std::function<void(const RowRange& rows, const RowArrays& arrays)>;

}  // namespace bodyscan
