#include "hal/drm/connector.hpp"

#include "hal/drm/atomic_request.hpp"
#include "hal/drm/edid.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace bodyscan {
namespace {

// As the kernel names it: "HDMI-A-1".
std::string connector_name(const drmModeConnector& connector) {
  const char* type = drmModeGetConnectorTypeName(connector.connector_type);
  return std::string(type != nullptr ? type : "Unknown") + "-" + std::to_string(connector.connector_type_id);
}

std::string edid_text(int fd, std::uint32_t connector_id) {
  const KmsObject connector = KmsObject::connector(fd, connector_id);
  const auto blob_id = static_cast<std::uint32_t>(connector.value("EDID").value_or(0));
  const KmsBlob blob(blob_id != 0 ? drmModeGetPropertyBlob(fd, blob_id) : nullptr);
  if (!blob) return unidentified;
  const Expected<Edid> edid = parse_edid({static_cast<const std::byte*>(blob->data), blob->length});
  return edid ? identity(*edid) : unidentified;
}

}  // namespace

std::optional<DisplayMode> display_mode(const drmModeModeInfo& timing) {
  constexpr std::uint32_t altered = DRM_MODE_FLAG_INTERLACE | DRM_MODE_FLAG_DBLSCAN;
  if ((timing.flags & altered) != 0 || timing.vscan > 1 || timing.htotal == 0 || timing.vtotal == 0)
    return std::nullopt;
  const double pixels = static_cast<double>(timing.htotal) * timing.vtotal;
  return DisplayMode{{timing.hdisplay, timing.vdisplay}, timing.clock * 1000.0 / pixels};
}

Expected<Connector> read_connector(const DrmDevice& device, std::uint32_t id, Probe probe) {
  const KmsConnector answer(probe == Probe::forced ? drmModeGetConnector(device.fd(), id)
                                                   : drmModeGetConnectorCurrent(device.fd(), id));
  if (!answer) return device.error("a connector cannot be read");
  Connector connector{id, {connector_name(*answer), {}, {}}, {}};
  if (answer->connection != DRM_MODE_CONNECTED) return connector;

  connector.output.edid = edid_text(device.fd(), id);
  std::vector<drmModeModeInfo> timings(answer->modes, answer->modes + answer->count_modes);
  std::stable_partition(timings.begin(), timings.end(), [](const drmModeModeInfo& timing) {
    return (timing.type & DRM_MODE_TYPE_PREFERRED) != 0;
  });
  for (const drmModeModeInfo& timing : timings) {
    const std::optional<DisplayMode> mode = display_mode(timing);
    if (!mode) continue;
    connector.output.modes.push_back(*mode);
    connector.timings.push_back(timing);
  }
  return connector;
}

Expected<std::vector<Connector>> read_connectors(const DrmDevice& device, Probe probe) {
  const KmsResources resources(drmModeGetResources(device.fd()));
  if (!resources) return device.error("its connectors cannot be listed");
  std::vector<Connector> connectors;
  for (const std::uint32_t id : std::span(resources->connectors, resources->count_connectors)) {
    Expected<Connector> connector = read_connector(device, id, probe);
    if (!connector) return tl::unexpected(connector.error());
    connectors.push_back(std::move(*connector));
  }
  return connectors;
}

}  // namespace bodyscan
