#pragma once

#include <cstdint>

#include "pipeline/base/image.hpp"
#include "pipeline/decode/correspondence.hpp"

namespace bodyscan {

// The camera's blur at brightness edges (the rim of a mole, a printed square, a silhouette): a pixel there sees the
// brighter side's stripes more than its own place's.
// - A pixel with less than `min_share` of the contrast of the brightest within two pixels shows its neighbours'
//   stripes, not its own, and becomes undecided.
// - Elsewhere, for a Gaussian blur of variance s^2 (px^2), the coordinate is off by s^2 grad(u) . grad(C) / C, with u
//   the coordinate and C the contrast as photographed. s^2 is measured on the capture, by regression of the
//   coordinate's second differences on those of that term, and the error is taken off.
// Returns s^2; 0, and nothing corrected, where the picture has too few brightness edges to tell.
float correct_camera_blur(AxisCorrespondence& axis, const Image<std::uint16_t>& contrast, float min_share);

}  // namespace bodyscan
