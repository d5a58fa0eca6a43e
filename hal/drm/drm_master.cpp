#include "hal/drm/drm_master.hpp"

#include "hal/clock.hpp"
#include "hal/drm/connector.hpp"
#include "hal/drm/lit_output.hpp"
#include "hal/drm/output_choice.hpp"
#include "hal/drm/scanout_path.hpp"

#include <algorithm>
#include <utility>

#include <poll.h>

namespace bodyscan {
namespace {

constexpr std::int64_t identification_limit_us = 300'000;

Expected<Connector> find_connector(const DrmDevice& device, const std::string& name) {
  Expected<std::vector<Connector>> connectors = read_connectors(device, Probe::remembered);
  if (!connectors) return tl::unexpected(connectors.error());
  for (Connector& connector : *connectors)
    if (connector.output.connector == name) return std::move(connector);
  return device_error(device.path() + ": has no connector " + name);
}

bool is_unidentified(const Connector& connector) {
  return connector.output.edid == unidentified;
}

// While a plug moves, and shortly after, a display may be found whose EDID cannot be read.
Expected<std::vector<Connector>> ask_displays(const DrmDevice& device) {
  const std::int64_t until_us = monotonic_us() + identification_limit_us;
  for (;;) {
    Expected<std::vector<Connector>> connectors = read_connectors(device, Probe::forced);
    if (!connectors || std::none_of(connectors->begin(), connectors->end(), is_unidentified) ||
        monotonic_us() > until_us)
      return connectors;
    poll(nullptr, 0, 20);
  }
}

Expected<std::vector<ProjectorOutput>> outputs_of(const DrmDevice& device) {
  Expected<std::vector<Connector>> connectors = ask_displays(device);
  if (!connectors) return tl::unexpected(connectors.error());
  std::vector<ProjectorOutput> outputs;
  for (Connector& connector : *connectors) outputs.push_back(std::move(connector.output));
  return outputs;
}

}  // namespace

DrmMaster::DrmMaster(DrmDevice device, HotplugMonitor hotplug)
    : device_(std::move(device)), hotplug_(std::move(hotplug)), flips_(device_) {}

DrmMaster::~DrmMaster() = default;

Expected<std::shared_ptr<DrmMaster>> DrmMaster::open(const std::string& card) {
  Expected<DrmDevice> device = DrmDevice::open(card);
  if (!device) return tl::unexpected(device.error());
  if (Expected<void> master = device->become_master(); !master) return tl::unexpected(master.error());
  Expected<HotplugMonitor> hotplug = HotplugMonitor::open();
  if (!hotplug) return tl::unexpected(hotplug.error());
  return std::shared_ptr<DrmMaster>(new DrmMaster(std::move(*device), std::move(*hotplug)));
}

Expected<std::vector<ProjectorOutput>> DrmMaster::probe() {
  static_cast<void>(hotplug_.take_change());
  return outputs_of(device_);
}

Expected<ProjectorOutput> DrmMaster::look_at(const std::string& connector) {
  if (hotplug_.take_change())
    if (const auto asked = ask_displays(device_); !asked) return tl::unexpected(asked.error());
  return find_connector(device_, connector).map([](Connector&& found) { return std::move(found.output); });
}

Expected<void> DrmMaster::light(const std::string& connector, const DisplayMode& mode) {
  const Expected<Connector> found = find_connector(device_, connector);
  if (!found) return tl::unexpected(found.error());
  const auto& modes = found->output.modes;
  const auto offered = std::find(modes.begin(), modes.end(), mode);
  if (offered == modes.end()) return device_error(connector + ": does not offer " + describe(mode));
  const drmModeModeInfo& timing = found->timings[static_cast<std::size_t>(offered - modes.begin())];

  if (const auto lit = lit_.find(connector); lit != lit_.end()) {
    if (lit->second->is_lit() && display_mode(lit->second->timing()) == mode)
      return show(connector, GrayImage8(mode.size, 0)).map([](std::int64_t) {});
    lit_.erase(lit);
  }
  std::vector<std::uint32_t> taken;
  for (const auto& [other, output] : lit_) taken.push_back(output->crtc());
  const Expected<ScanoutPath> path = find_scanout_path(device_, found->id, taken);
  if (!path) return tl::unexpected(path.error());
  Expected<std::unique_ptr<LitOutput>> output = LitOutput::light(device_, flips_, *path, timing);
  if (!output) return tl::unexpected(output.error());
  lit_[connector] = std::move(*output);
  return {};
}

bool DrmMaster::is_lit(const std::string& connector) const {
  const auto lit = lit_.find(connector);
  return lit != lit_.end() && lit->second->is_lit();
}

Expected<std::int64_t> DrmMaster::show(const std::string& connector, const GrayImage8& picture) {
  const auto lit = lit_.find(connector);
  if (lit == lit_.end()) return device_error(connector + ": is not lit");
  return lit->second->show(picture);
}

void DrmMaster::darken(const std::string& connector) {
  lit_.erase(connector);
}

Expected<std::vector<ProjectorOutput>> list_outputs(const std::string& card) {
  const Expected<DrmDevice> device = DrmDevice::open(card);
  if (!device) return tl::unexpected(device.error());
  return outputs_of(*device);
}

}  // namespace bodyscan
