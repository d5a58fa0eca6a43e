#include "hal/rig/devices.hpp"

#include "hal/gphoto2/gphoto2_camera.hpp"
#include "hal/replay/replay_camera.hpp"
#include "hal/virtual_projector/virtual_projector.hpp"

namespace bodyscan {

Expected<std::unique_ptr<Camera>> make_camera(const CameraConfig& config) {
  if (config.backend == CameraBackend::replay) {
    Expected<CaptureFolder> folder = CaptureFolder::open(config.folder);
    if (!folder) return tl::unexpected(folder.error());
    return std::make_unique<ReplayCamera>(std::move(*folder));
  }
  return std::make_unique<gphoto2::Gphoto2Camera>(gphoto2::Gphoto2Options{config.port, {}, {}});
}

std::unique_ptr<Projector> make_projector(const ProjectorConfig& config, Size calibrated) {
  ProjectorChoice choice;
  choice.edid = config.edid;
  choice.mode = {calibrated, config.refresh_hz};
  return std::make_unique<VirtualProjector>(config.socket, choice);
}

}  // namespace bodyscan
