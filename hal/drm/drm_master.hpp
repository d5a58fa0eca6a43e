#pragma once

#include "hal/drm/drm_device.hpp"
#include "hal/drm/hotplug_monitor.hpp"
#include "hal/drm/page_flips.hpp"
#include "hal/projector.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace bodyscan {

class LitOutput;

// The one that drives the displays: it owns the graphics card and all outputs that are lit, told apart by
// their connectors' names. Only one program at a time can be it. What it lit stays lit until it is darkened
// or the master goes away. Errors are of kind `device`. Not thread-safe.
class DrmMaster {
 public:
  // Without a path (/dev/dri/cardN): the first card with display connectors.
  static Expected<std::shared_ptr<DrmMaster>> open(const std::string& card = {});
  DrmMaster(const DrmMaster&) = delete;
  DrmMaster& operator=(const DrmMaster&) = delete;
  ~DrmMaster();

  // All connectors; every display is asked anew, for up to 0.3 s where one does not say what it is.
  Expected<std::vector<ProjectorOutput>> probe();
  // One connector, as the kernel knows it: displays are asked only where one was plugged in or unplugged.
  Expected<ProjectorOutput> look_at(const std::string& connector);

  // Black, in a mode that the connector offers. Does nothing but show black where it is lit so already.
  Expected<void> light(const std::string& connector, const DisplayMode& mode);
  // Whether the connector is lit in the mode that it was lit in.
  [[nodiscard]] bool is_lit(const std::string& connector) const;
  // A picture of the mode's size. Returns the time of the page flip (us, CLOCK_MONOTONIC), or an error after
  // a second without one.
  Expected<std::int64_t> show(const std::string& connector, const GrayImage8& picture);
  // Switches the signal off.
  void darken(const std::string& connector);

 private:
  DrmMaster(DrmDevice device, HotplugMonitor hotplug);

  DrmDevice device_;
  HotplugMonitor hotplug_;
  PageFlips flips_;
  std::map<std::string, std::unique_ptr<LitOutput>> lit_;  // by connector
};

// What `bodyscan rig list` shows; leaves the displays as they are.
Expected<std::vector<ProjectorOutput>> list_outputs(const std::string& card = {});

}  // namespace bodyscan
