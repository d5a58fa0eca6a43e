#pragma once

#include "pipeline/decode/correspondence.hpp"
#include "pipeline/decode/decode_options.hpp"
#include "pipeline/decode/illumination.hpp"
#include "pipeline/decode/stripe_planes.hpp"

namespace bodyscan {

// The projector coordinate of every lit pixel of one axis with `count` rows or columns, before any smoothing.
// Integer part: the Gray code without the bits the optics do not resolve there. Fraction: the position
// between the two nearest zero crossings of pattern minus inverse, from the pixel's own two differences
// (edge_ratio.hpp) and the edge profile measured around it (edge_profile.hpp): no neighbour's value enters,
// so no relief is lost and any angle between camera and projector will do. Pixels lit by scattered light only
// are undecided.
AxisCorrespondence locate_stripes(const StripePlanes& planes, const Illumination& light, int count,
                                  const DecodeOptions& options);

}  // namespace bodyscan
