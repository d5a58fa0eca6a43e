#include "hal/drm/scanout_path.hpp"

#include "hal/drm/atomic_request.hpp"
#include "hal/drm/kms_answers.hpp"

#include <algorithm>
#include <optional>
#include <span>

namespace bodyscan {
namespace {

std::uint32_t current_crtc(int fd, std::uint32_t connector) {
  return static_cast<std::uint32_t>(KmsObject::connector(fd, connector).value("CRTC_ID").value_or(0));
}

bool contains(const std::vector<std::uint32_t>& ids, std::uint32_t id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

// A bit each, by the CRTC's place in the card's list.
std::uint32_t possible_crtcs(int fd, std::uint32_t connector) {
  const KmsConnector answer(drmModeGetConnectorCurrent(fd, connector));
  return answer ? drmModeConnectorGetPossibleCrtcs(fd, answer.get()) : 0;
}

std::optional<std::uint32_t> primary_plane(int fd, std::uint32_t crtc_bit) {
  const KmsPlanes planes(drmModeGetPlaneResources(fd));
  if (!planes) return std::nullopt;
  for (const std::uint32_t id : std::span(planes->planes, planes->count_planes)) {
    const KmsPlane plane(drmModeGetPlane(fd, id));
    if (plane && (plane->possible_crtcs & crtc_bit) != 0 &&
        KmsObject::plane(fd, id).value("type") == DRM_PLANE_TYPE_PRIMARY)
      return id;
  }
  return std::nullopt;
}

}  // namespace

Expected<ScanoutPath> find_scanout_path(const DrmDevice& device, std::uint32_t connector,
                                        const std::vector<std::uint32_t>& taken) {
  const KmsResources resources(drmModeGetResources(device.fd()));
  if (!resources) return device.error("its parts cannot be listed");
  const std::span crtcs(resources->crtcs, static_cast<std::size_t>(resources->count_crtcs));

  std::vector<std::uint32_t> busy = taken;
  for (const std::uint32_t other : std::span(resources->connectors, resources->count_connectors))
    if (other != connector) busy.push_back(current_crtc(device.fd(), other));
  const std::uint32_t kept = current_crtc(device.fd(), connector);
  const std::uint32_t possible = possible_crtcs(device.fd(), connector);

  std::optional<ScanoutPath> path;
  for (std::size_t i = 0; i < crtcs.size() && i < 32; ++i) {
    const std::uint32_t bit = std::uint32_t{1} << i;
    if ((possible & bit) == 0 || contains(busy, crtcs[i]) || (path && crtcs[i] != kept)) continue;
    if (const auto plane = primary_plane(device.fd(), bit)) path = {connector, crtcs[i], *plane};
  }
  if (!path) return device_error(device.path() + ": no CRTC is left; all of them light other displays");
  return *path;
}

}  // namespace bodyscan
