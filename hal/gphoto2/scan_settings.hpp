#pragma once

#include "hal/gphoto2/session.hpp"

namespace bodyscan::gphoto2 {

inline constexpr const char* dial_problem = "the mode dial is not on M: turn it to M";

// Everything a scan needs: pictures go to the computer, not to a card; nothing is automatic; JPEG of the best
// quality. Answers what the camera then says it has set.
Outcome<CameraSettings> apply_scan_settings(Session& session, const CameraSettings& wanted);

// The shutter and the aperture obey the computer. True where the camera does not tell.
Outcome<bool> dial_is_manual(Session& session);

// The aperture's setting, whatever this make calls it.
Outcome<std::optional<Setting>> aperture_setting(Session& session);

}  // namespace bodyscan::gphoto2
