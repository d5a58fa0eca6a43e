#include "hal/rig/devices.hpp"

#include "hal/drm/drm_projector.hpp"
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

Expected<std::unique_ptr<Projector>> make_projector(const ProjectorConfig& config, Size calibrated) {
  const ProjectorChoice choice{config.connector, config.edid, {calibrated, config.refresh_hz}};
  if (config.backend == ProjectorBackend::drm) {
    Expected<std::shared_ptr<DrmMaster>> master = DrmMaster::open(config.card);
    if (!master) return tl::unexpected(master.error());
    return std::make_unique<DrmProjector>(std::move(*master), choice);
  }
  return std::make_unique<VirtualProjector>(config.socket, choice);
}

}  // namespace bodyscan
