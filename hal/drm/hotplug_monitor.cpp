#include "hal/drm/hotplug_monitor.hpp"

#include <array>
#include <cerrno>
#include <cstring>

#include <linux/netlink.h>
#include <sys/socket.h>

namespace bodyscan {
namespace {

constexpr unsigned kernel_events = 1;  // multicast group; 2 is udev's

}  // namespace

bool is_display_hotplug(std::string_view uevent) {
  bool display = false;
  bool hotplug = false;
  while (!uevent.empty()) {
    const std::string_view field = uevent.substr(0, uevent.find('\0'));
    display = display || field == "SUBSYSTEM=drm";
    hotplug = hotplug || field == "HOTPLUG=1";
    uevent.remove_prefix(field.size());
    if (!uevent.empty()) uevent.remove_prefix(1);
  }
  return display && hotplug;
}

Expected<HotplugMonitor> HotplugMonitor::open() {
  UniqueFd socket(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, NETLINK_KOBJECT_UEVENT));
  sockaddr_nl address{};
  address.nl_family = AF_NETLINK;
  address.nl_groups = kernel_events;
  if (!socket || bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return device_error(std::string("kernel events cannot be listened to: ") + std::strerror(errno));
  return HotplugMonitor(std::move(socket));
}

bool HotplugMonitor::take_change() {
  bool changed = false;
  std::array<char, 8192> message{};
  for (;;) {
    const ssize_t size = recv(socket_.get(), message.data(), message.size(), 0);
    if (size > 0)
      changed |= is_display_hotplug({message.data(), static_cast<std::size_t>(size)});
    else if (size < 0 && errno == ENOBUFS)
      changed = true;  // events were lost
    else if (size >= 0 || errno != EINTR)
      return changed;
  }
}

}  // namespace bodyscan
