#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/pattern/sequence.hpp"

#include <variant>

namespace bodyscan {

// One photograph's brightness, encoded as the camera wrote it (not linear), in 8 or 16 bits.
using Luma = std::variant<GrayImage8, GrayImage16>;

inline Size size_of(const Luma& luma) {
  return std::visit([](const auto& image) { return image.size(); }, luma);
}

// A photograph and the pattern the projector showed in it.
struct Frame {
  Pattern pattern;
  Luma luma;
};

}  // namespace bodyscan
