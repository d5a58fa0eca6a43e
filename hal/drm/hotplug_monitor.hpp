#pragma once

#include "hal/unique_fd.hpp"
#include "pipeline/base/error.hpp"

#include <string_view>

namespace bodyscan {

// Whether a kernel event ("change@/devices/...", then KEY=value, each ended by a zero) tells that something
// was plugged in or unplugged at a display connector.
bool is_display_hotplug(std::string_view uevent);

// Listens to the kernel's events (netlink), without udev.
class HotplugMonitor {
 public:
  static Expected<HotplugMonitor> open();

  // Whether a display was plugged in or unplugged since the last call; does not wait.
  bool take_change();

 private:
  explicit HotplugMonitor(UniqueFd socket) : socket_(std::move(socket)) {}

  UniqueFd socket_;
};

}  // namespace bodyscan
