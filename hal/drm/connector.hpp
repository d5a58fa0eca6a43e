#pragma once

#include "hal/drm/drm_device.hpp"
#include "hal/drm/kms_answers.hpp"
#include "hal/projector.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bodyscan {

// In place of the EDID's identity, where something is plugged in that does not say what it is.
inline constexpr const char* unidentified = "unidentified";

// A connector of the card and what is plugged in there.
struct Connector {
  std::uint32_t id = 0;
  ProjectorOutput output;
  std::vector<drmModeModeInfo> timings;  // of output.modes, one for one
};

enum class Probe {
  remembered,  // what the kernel found last: microseconds
  forced,  // the kernel asks the display anew: tens of milliseconds; remembered where another is DRM master
};

Expected<Connector> read_connector(const DrmDevice& device, std::uint32_t id, Probe probe);
Expected<std::vector<Connector>> read_connectors(const DrmDevice& device, Probe probe);

// None where the picture would not be shown line for line as it is (interlaced, lines doubled).
std::optional<DisplayMode> display_mode(const drmModeModeInfo& timing);

}  // namespace bodyscan
