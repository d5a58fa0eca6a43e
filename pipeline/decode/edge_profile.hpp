#pragma once

#include "pipeline/base/image.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace bodyscan {

// How the edge ratio (edge_ratio.hpp) runs from one stripe edge to the next: the optics' edge-spread
// function, measured from the capture itself, tile by tile. Over a surface that crosses many stripes every
// position between two edges is as frequent as any other, so position = cumulative distribution of the ratio;
// kept as
//   position = r + r (1 - r) (c0 + c1 t + c2 t^2 + c3 t^3),  t = 2 r - 1.
// Where light spreads far (subsurface scattering) an edge's slope depends on how near that bit's next edge
// is, so there are two profiles: for stripes whose coarse edge belongs to the bit next to the fine one (an
// edge every four stripes) and to any bit beyond (eight and more).
class EdgeProfile {
 public:
  static constexpr int tile_px = 64;
  static constexpr int terms = 4;
  static constexpr int kinds = 2;
  using Coefficients = std::array<std::array<float, terms>, kinds>;

  // Which of the two profiles a stripe follows; `cell` as of measure_edge_ratio.
  static constexpr unsigned kind_of(unsigned cell) { return ((cell + (cell & 1)) >> 1) & 1; }

  // Counts ratios by tile; several may run side by side and be added up.
  class Histogram {
   public:
    static constexpr int bins = 64;
    explicit Histogram(Size camera);
    // Columns [begin, end) of camera row y; the arrays hold the whole row, a NaN ratio is left out.
    void add_run(int y, int begin, int end, const float* ratios, const std::uint16_t* cells);

   private:
    friend class EdgeProfile;
    using Counts = std::array<std::uint32_t, kinds * bins + 1>;  // kind by kind, then what is left out
    Image<Counts> counts_;
  };

  // Of stripes of 2^dropped rows.
  EdgeProfile(const Histogram& histogram, int dropped);

  // The polynomials' coefficients at each pixel of camera row y, between tiles bilinear: kinds x terms arrays
  // of `width` floats, one after the other.
  void coefficients_of_row(int y, int width, float* coefficients) const;

 private:
  Image<Coefficients> tiles_;
};

}  // namespace bodyscan
