#include "hal/rig/rig_file.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace {

bool lies_in(double value, double least, double most) {
  return value >= least && value <= most;
}

// What the parser promises of every rig that it accepts.
bool keeps_promises(const bodyscan::Rig& rig) {
  const bodyscan::CameraSettings& settings = rig.camera.settings;
  const bodyscan::Size picture = settings.picture;
  return !rig.calibration.empty() &&
         (rig.camera.backend != bodyscan::CameraBackend::replay || !rig.camera.folder.empty()) &&
         (rig.projector.backend != bodyscan::ProjectorBackend::virtual_socket ||
          !rig.projector.socket.empty()) &&
         lies_in(settings.exposure_us, 100, 1e7) && lies_in(settings.iso, 50, 102'400) &&
         lies_in(settings.aperture, 0.7, 64) &&
         (picture == bodyscan::Size{} ||
          (lies_in(picture.width, 1, 16384) && lies_in(picture.height, 1, 16384))) &&
         lies_in(rig.projector.refresh_hz, 10, 1000) && lies_in(rig.projector.settle_ms, 0, 5000) &&
         lies_in(rig.scan.attempts, 1, 20) && lies_in(rig.scan.max_motion_mm, 0.01, 1000) &&
         lies_in(rig.scan.max_light_s, 1, 3600);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto rig = bodyscan::parse_rig(text, "fuzz.toml", "/station");
  if (rig ? !keeps_promises(*rig) : rig.error().message.empty()) std::abort();
  return 0;
}
