#pragma once

#include "hal/drm/drm_device.hpp"

#include <cstdint>
#include <vector>

namespace bodyscan {

// The parts of a card that light one connector: the plane's framebuffer goes through the CRTC to it.
struct ScanoutPath {
  std::uint32_t connector = 0;
  std::uint32_t crtc = 0;
  std::uint32_t plane = 0;  // the CRTC's primary one
};

// Keeps the CRTC that the connector has, and otherwise takes one that no other connector has and that is not
// in `taken`.
Expected<ScanoutPath> find_scanout_path(const DrmDevice& device, std::uint32_t connector,
                                        const std::vector<std::uint32_t>& taken);

}  // namespace bodyscan
