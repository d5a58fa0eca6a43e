#include "app/scan/scan.hpp"

#include <nlohmann/json.hpp>

namespace bodyscan {

std::string to_json(const ScanReport& report) {
  using Json = nlohmann::ordered_json;
  const ShootingReport& shooting = report.shooting;
  Json json = json_of(report.model);
  json["scan"] = {
      {"camera", {{"model", report.camera.model}, {"serial", report.camera.serial}}},
      {"exposure_us", report.settings.exposure_us},
      {"iso", report.settings.iso},
      {"aperture", report.settings.aperture},
      {"shots", shooting.shots},
      {"refused", report.refused},
      {"troubles", shooting.troubles},
      {"motion_px", report.motion.largest_px},
      {"motion_mm", report.motion_mm},
      {"motion_at_px", {report.motion.at.x(), report.motion.at.y()}},
      {"shot_again_for_motion", report.shot_again_for_motion},
      {"light_s", report.light_s},
      {"after_last_shot_ms", report.after_last_shot_ms},
      {"times_ms",
       {{"show", shooting.show_ms},
        {"settle", shooting.settle_ms},
        {"exposure", shooting.exposure_ms},
        {"camera", shooting.camera_ms},
        {"fetch", shooting.fetch_ms},
        {"recovery", shooting.recovery_ms},
        {"total", shooting.total_ms}}},
  };
  return text_of(json);
}

}  // namespace bodyscan
