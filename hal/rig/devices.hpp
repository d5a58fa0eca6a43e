#pragma once

#include "hal/camera.hpp"
#include "hal/projector.hpp"
#include "hal/rig/rig_file.hpp"
#include "pipeline/base/error.hpp"

#include <memory>

namespace bodyscan {

// The backend that a rig names, closed. Error: a capture folder to replay that is not there or damaged.
Expected<std::unique_ptr<Camera>> make_camera(const CameraConfig& config);

// `calibrated`: the size that the projector was calibrated at. Error: no graphics card.
Expected<std::unique_ptr<Projector>> make_projector(const ProjectorConfig& config, Size calibrated);

}  // namespace bodyscan
