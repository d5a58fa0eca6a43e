#include "hal/drm/hotplug_monitor.hpp"

#include <string>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

using namespace std::string_literals;

const std::string hotplug =
    "change@/devices/pci0000:00/0000:00:02.0/drm/card0\0ACTION=change\0DEVPATH=/devices/pci0000:00/"
    "0000:00:02.0/drm/card0\0"
    "SUBSYSTEM=drm\0HOTPLUG=1\0DEVNAME=dri/card0\0SEQNUM=1\0"s;

TEST(DisplayHotplug, IsAHotplugEventOfTheDisplays) {
  EXPECT_TRUE(is_display_hotplug(hotplug));
  EXPECT_TRUE(is_display_hotplug("SUBSYSTEM=drm\0HOTPLUG=1"s));
}

TEST(DisplayHotplug, IsNothingElse) {
  EXPECT_FALSE(is_display_hotplug(""));
  EXPECT_FALSE(is_display_hotplug("\0\0\0"s));
  EXPECT_FALSE(is_display_hotplug("add@/devices/x\0ACTION=add\0SUBSYSTEM=usb\0HOTPLUG=1\0"s));
  EXPECT_FALSE(is_display_hotplug("change@/x\0SUBSYSTEM=drm\0LEASE=1\0"s));
  EXPECT_FALSE(is_display_hotplug("SUBSYSTEM=drm HOTPLUG=1"s));
  for (std::size_t size = 0; size < hotplug.find("HOTPLUG=1") + 9; ++size)
    EXPECT_FALSE(is_display_hotplug(hotplug.substr(0, size))) << size;
}

TEST(HotplugMonitor, HearsNothingWhereNothingIsPlugged) {
  Expected<HotplugMonitor> monitor = HotplugMonitor::open();
  ASSERT_TRUE(monitor) << monitor.error().message;
  EXPECT_FALSE(monitor->take_change());
}

}  // namespace
}  // namespace bodyscan
