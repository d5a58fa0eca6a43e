#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/base/image.hpp"

namespace bodyscan {

// How the edge ratio (edge_ratio.hpp) runs from one stripe edge to the next: the optics' edge-spread function,
// measured from the capture itself, tile by tile. Over a surface that crosses many stripes every position
// between two edges is as frequent as any other, so position = cumulative distribution of the ratio; kept as
//   position = r + r (1 - r) (c0 + c1 t + c2 t^2 + c3 t^3),  t = 2 r - 1.
class EdgeProfile {
 public:
  static constexpr int tile_px = 64;
  static constexpr int terms = 4;
  using Coefficients = std::array<float, terms>;

  // Counts ratios by tile; several may run side by side and be added up.
  class Histogram {
   public:
    static constexpr int bins = 64;
    explicit Histogram(Size camera);
    // Ratios of columns [begin, end) of camera row y; `ratios` is the whole row, NaN is left out.
    void add_run(int y, int begin, int end, const float* ratios);

   private:
    friend class EdgeProfile;
    Image<std::array<std::uint32_t, bins>> counts_;
  };

  explicit EdgeProfile(const Histogram& histogram);

  // The polynomial's coefficients at each pixel of camera row y, between tiles bilinear: terms arrays of
  // `width` floats, one after the other.
  void coefficients_of_row(int y, int width, float* coefficients) const;

 private:
  Image<Coefficients> tiles_;
};

}  // namespace bodyscan
