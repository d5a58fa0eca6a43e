#pragma once

#include "app/scan/live_decoder.hpp"
#include "hal/camera.hpp"
#include "pipeline/base/error.hpp"
#include "pipeline/pattern/sequence.hpp"

#include <filesystem>

namespace bodyscan {

// The photographs of a sequence as a capture folder, which is made where it is not there.
Expected<void> keep_photographs(const std::filesystem::path& folder, const PatternSequence& sequence,
                                const LiveDecoder& decoder, const CameraIdentity& camera,
                                const CameraSettings& settings);

}  // namespace bodyscan
