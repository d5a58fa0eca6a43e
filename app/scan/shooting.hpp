#pragma once

#include "app/scan/light_guard.hpp"
#include "app/scan/live_decoder.hpp"
#include "app/scan/shot_list.hpp"
#include "hal/camera.hpp"
#include "hal/rig/rig_file.hpp"
#include "pipeline/base/error.hpp"
#include "pipeline/pattern/sequence.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace bodyscan {

// Where the time of a sequence went, and what went wrong on the way.
struct ShootingReport {
  int shots = 0;
  double show_ms = 0;      // until the page flip
  double settle_ms = 0;    // of waiting after it: what fetching the picture before did not take anyway
  double exposure_ms = 0;  // what the camera was set to
  double camera_ms = 0;    // what exposing took beyond that
  double fetch_ms = 0;
  double recovery_ms = 0;
  double total_ms = 0;
  std::vector<std::string> troubles;  // that were overcome
};

// With devices that do not answer.
struct Patience {
  int retry_every_ms = 1000;
  int give_up_after_ms = 10'000;
};

// Shows, settles, exposes and fetches what a shot list asks for, and hands the photographs over. The next
// pattern is shown while the last picture travels:
//
//   time = sum over shots of (flip + max(settle, fetch of the shot before) + exposure + the camera's own)
//
// A camera or projector that fails is closed and opened again, for as long as patience lasts, and the
// sequence goes on where it stopped.
class Shooting {
 public:
  Shooting(Camera& camera, LightGuard& light, const Rig& rig, PatternSequence sequence,
           const Patience& patience = {});

  // Opens both devices. Device errors; among them a camera with problems such as a dial at the wrong place.
  Expected<void> open();
  [[nodiscard]] const CameraIdentity& identity() const { return identity_; }
  [[nodiscard]] const CameraSettings& settings() const { return settings_; }

  // `progress` is told the shots made so far.
  Expected<void> shoot(ShotList& list, LiveDecoder& decoder, const std::function<void(int)>& progress);
  [[nodiscard]] const ShootingReport& report() const { return report_; }

 private:
  Expected<void> open_camera();
  Expected<void> recover_camera(const Error& trouble);
  Expected<void> recover_projector(const Error& trouble);
  // `retry` while it fails and patience lasts.
  Expected<void> persist(const std::function<Expected<void>()>& retry);
  Expected<void> show(const PlannedShot& shot);
  Expected<void> expose();
  Expected<Photograph> fetch();

  Camera& camera_;
  LightGuard& light_;
  const Rig& rig_;
  PatternSequence sequence_;
  Patience patience_;
  CameraIdentity identity_;
  CameraSettings settings_;
  std::int64_t flip_us_ = 0;
  int failures_ = 0;  // of shots in a row
  ShootingReport report_;
};

}  // namespace bodyscan
