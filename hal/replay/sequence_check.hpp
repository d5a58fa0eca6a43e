#pragma once

#include "hal/replay/capture_manifest.hpp"

#include <vector>

namespace bodyscan {

// Whether frames, each pattern once, add up to a sequence that can be decoded; the message names what is
// missing or too much: "frames: gray row bit 1 is missing".
Expected<void> check_sequence(const std::vector<ManifestFrame>& frames, Size projector);

}  // namespace bodyscan
