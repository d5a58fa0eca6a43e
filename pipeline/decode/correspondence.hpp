#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/image/tone_response.hpp"

#include <optional>

namespace bodyscan {

// Which projector row (or column) each camera pixel sees, on the camera's pixel grid.
struct AxisCorrespondence {
  FloatImage coordinate;  // projector px, centres at integers; NaN where undecided
  FloatImage sigma;       // its standard deviation, projector px; meaningless where undecided
};

struct Correspondence {
  Size camera;
  Size projector;
  std::optional<AxisCorrespondence> rows;
  std::optional<AxisCorrespondence> columns;
  ToneResponse response;           // that the frames were read with
  std::size_t pixels_lit = 0;      // bright enough in white minus black
  std::size_t pixels_decoded = 0;  // every axis of the sequence decided
};

}  // namespace bodyscan
