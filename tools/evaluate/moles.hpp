#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/model/mesh.hpp"
#include "tools/evaluate/truth.hpp"

#include <vector>

namespace bodyscan {

// A mole that camera and projector both see whole.
struct MoleResult {
  double diameter_mm = 0;
  std::size_t pixels = 0;    // within one diameter of its centre
  double covered = 0;        // share of them that the model covers
  double contrast_kept = 0;  // slope of the regression of the model's on the photograph's linear brightness
};

// The model's colours as the camera would see them, interpolated over its faces (points without faces colour
// their own pixel), against the white frame.
std::vector<MoleResult> measure_moles(const Truth& truth, const Mesh& model, const ColorImage8& white);

// Mean of the linear red, green and blue of the model, 0..1, on the camera's pixel grid; NaN where there is
// none.
FloatImage model_brightness(const Lens& camera, const Mesh& model);

}  // namespace bodyscan
