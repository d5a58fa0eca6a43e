#include "hal/drm/drm_device.hpp"

#include "hal/drm/kms_answers.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <vector>

#include <fcntl.h>

namespace bodyscan {
namespace {

constexpr const char* cards_folder = "/dev/dri";

std::vector<std::string> cards() {
  std::vector<std::string> paths;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(cards_folder, none))
    if (entry.path().filename().string().starts_with("card")) paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

bool has_connectors(int fd) {
  const KmsResources resources(drmModeGetResources(fd));
  return resources && resources->count_connectors > 0;
}

}  // namespace

Expected<DrmDevice> DrmDevice::open(const std::string& path) {
  if (!path.empty()) return open_card(path);
  Error last{ErrorKind::device, std::string(cards_folder) + ": no graphics card"};
  for (const std::string& card : cards()) {
    Expected<DrmDevice> device = open_card(card);
    if (device) return device;
    last = device.error();
  }
  return tl::unexpected(last);
}

Expected<DrmDevice> DrmDevice::open_card(const std::string& path) {
  DrmDevice device(UniqueFd(::open(path.c_str(), O_RDWR | O_CLOEXEC)), path);
  if (!device.fd_) return device.error("cannot be opened");
  if (!has_connectors(device.fd())) return device_error(path + ": has no display connectors");
  if (drmSetClientCap(device.fd(), DRM_CLIENT_CAP_UNIVERSAL_PLANES, 1) != 0 ||
      drmSetClientCap(device.fd(), DRM_CLIENT_CAP_ATOMIC, 1) != 0)
    return device_error(path + ": its driver cannot do atomic modesetting");
  return device;
}

Expected<void> DrmDevice::become_master() const {
  if (drmIsMaster(fd()) != 0 || drmSetMaster(fd()) == 0) return {};
  return error("the displays are driven by another program, such as a desktop");
}

tl::unexpected<Error> DrmDevice::error(const std::string& what) const {
  return device_error(path_ + ": " + what + ": " + std::strerror(errno));
}

}  // namespace bodyscan
