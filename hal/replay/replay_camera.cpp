#include "hal/replay/replay_camera.hpp"

#include "hal/clock.hpp"
#include "pipeline/base/read_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace bodyscan {
namespace {

// A manifest's number may be larger than a setting can be.
int whole(double value) {
  constexpr double most = std::numeric_limits<int>::max();
  return static_cast<int>(std::lround(std::min(value, most)));
}

}  // namespace

ReplayCamera::ReplayCamera(CaptureFolder folder) : folder_(std::move(folder)) {}

Expected<void> ReplayCamera::require(State needed) const {
  constexpr std::array names{"closed", "ready", "exposed"};
  const auto name = [&](State state) { return std::string(names.at(static_cast<std::size_t>(state))); };
  if (state_ == needed) return {};
  return device_error("replayed camera: is " + name(state_) + ", not " + name(needed));
}

Expected<Photograph> ReplayCamera::photograph(int frame) const {
  // The manifest's frames come first in no other list: capture.json is the first of the files.
  Expected<std::vector<std::byte>> file =
      read_file(folder_.files().at(static_cast<std::size_t>(frame) + 1), ImageLimits{}.max_file_bytes);
  if (!file) return tl::unexpected(Error{ErrorKind::device, "replayed camera: " + file.error().message});
  return Photograph{std::move(*file), monotonic_us()};
}

Expected<CameraIdentity> ReplayCamera::open() {
  state_ = State::ready;
  next_ = 0;
  return CameraIdentity{folder_.manifest().camera.value_or("replayed camera"), {}, {}};
}

Expected<CameraSettings> ReplayCamera::configure(const CameraSettings& wanted) {
  if (const Expected<void> right = require(State::ready); !right) return tl::unexpected(right.error());
  const CaptureManifest& manifest = folder_.manifest();
  CameraSettings settings = wanted;
  settings.exposure_us = whole(manifest.exposure_us.value_or(wanted.exposure_us));
  settings.iso = whole(manifest.iso.value_or(wanted.iso));
  settings.aperture = manifest.aperture.value_or(wanted.aperture);
  settings.picture = folder_.size();
  return settings;
}

Expected<void> ReplayCamera::expose() {
  if (Expected<void> right = require(State::ready); !right) return right;
  state_ = State::exposed;
  return {};
}

Expected<Photograph> ReplayCamera::fetch() {
  if (const Expected<void> right = require(State::exposed); !right) return tl::unexpected(right.error());
  state_ = State::ready;
  return photograph(std::exchange(next_, (next_ + 1) % folder_.frame_count()));
}

Expected<Photograph> ReplayCamera::preview() {
  if (const Expected<void> right = require(State::ready); !right) return tl::unexpected(right.error());
  return photograph(0);
}

void ReplayCamera::close() {
  state_ = State::closed;
}

}  // namespace bodyscan
