#pragma once

#include "pipeline/decode/coordinate_rows.hpp"
#include "pipeline/decode/decode_options.hpp"
#include "pipeline/decode/edge_profile.hpp"
#include "pipeline/decode/edge_ratio.hpp"
#include "pipeline/decode/stripe_planes.hpp"
#include "pipeline/decode/stripe_resolution.hpp"

#include <optional>
#include <vector>

namespace bodyscan {

// The projector coordinate of every lit pixel of one axis, before any smoothing. Integer part: the Gray code
// without the bits the optics do not resolve there. Fraction: the position between the two nearest zero
// crossings of pattern minus inverse, from the pixel's own two differences (edge_ratio.hpp) and the edge
// profile measured around it (edge_profile.hpp): no neighbour's value enters, so no relief is lost and any
// angle between camera and projector will do. Pixels lit by scattered light only are undecided.
class StripeLocator {
 public:
  // Measures the edge profiles. `planes` and `contrast` must outlive it; `count`: the projector's rows or
  // columns.
  StripeLocator(const StripePlanes& planes, const Image<std::uint16_t>& contrast, const NoiseModel& noise,
                StripeResolution resolution, int count, const DecodeOptions& options);

  // As CoordinateRows.
  void locate(const RowRange& rows, const RowArrays& arrays) const;

 private:
  struct RowBuffer;
  template <class Visit>
  void measure_row(int y, RowBuffer& buffer, Visit visit) const;
  [[nodiscard]] bool level_occurs(int dropped) const;

  const StripePlanes& planes_;
  const Image<std::uint16_t>& contrast_;
  EdgeRatioLimits limits_;
  StripeResolution resolution_;
  std::vector<std::optional<EdgeProfile>> profiles_;  // by number of dropped bits, where it occurs
};

}  // namespace bodyscan
