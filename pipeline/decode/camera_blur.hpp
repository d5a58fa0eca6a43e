#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/decode/coordinate_gradient.hpp"
#include "pipeline/decode/noise.hpp"

#include <cstdint>

namespace bodyscan {

// The camera's blur at brightness edges (the rim of a mole, a printed square, a silhouette): a pixel there
// sees the brighter side's stripes more than its own place's. For a Gaussian blur of variance s^2 (px^2) the
// coordinate is off by s^2 grad(u) . grad(C) / C, with u the coordinate and C the contrast as photographed. A
// lens has a core and a tail: two such terms, with the gradient of C over two pixels and over six.
struct CameraBlur {
  float core = 0;  // px^2
  float tail = 0;  // px^2
};

// Measured on the capture: a regression of the coordinate's second differences on those of the terms, where
// the latter stand out of their own noise (a regressor's noise would pull its slope towards zero). Zero where
// the picture has too few brightness edges to tell.
CameraBlur measure_camera_blur(const SampledRows& sampled, const GradientMap& gradients,
                               const Image<std::uint16_t>& contrast, const NoiseModel& noise);

// Takes the error off measured rows, and adds to sigma what the correction leaves open.
void correct_camera_blur(const CameraBlur& blur, const GradientMap& gradients,
                         const Image<std::uint16_t>& contrast, const RowRange& rows, const RowArrays& arrays);

}  // namespace bodyscan
