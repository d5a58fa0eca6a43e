#pragma once

#include "pipeline/base/image.hpp"
#include "tools/simulator/serve/moment.hpp"
#include "tools/simulator/serve/ptp/property.hpp"

#include <map>
#include <optional>
#include <span>
#include <vector>

namespace bodyscan::simulator {

// The device properties of a Nikon D5000 with a 35 mm lens, the two that both show the shutter's dial kept
// together.
class CameraSettings {
 public:
  // `picture`: the only picture size there is. `dial_on_manual`: with the mode dial elsewhere (on P), shutter
  // and aperture cannot be set.
  CameraSettings(Size picture, bool dial_on_manual);

  [[nodiscard]] std::vector<ptp::PropertyCode> codes() const;
  // Each answers nothing where the camera lacks the property.
  [[nodiscard]] std::optional<ptp::Bytes> description(ptp::PropertyCode code) const;
  [[nodiscard]] std::optional<ptp::Bytes> value(ptp::PropertyCode code) const;
  // An initiator's setting; `data` as it was sent.
  ptp::ResponseCode set(ptp::PropertyCode code, std::span<const std::uint8_t> data);
  // The camera's own change of a read-only byte.
  void show(ptp::PropertyCode code, std::uint8_t value);

  [[nodiscard]] Clock::duration exposure_time() const;
  // Brightness in relation to 50 ms at ISO 200 and f/8.
  [[nodiscard]] double exposure_gain() const;

 private:
  struct Entry {
    ptp::Property property;
    ptp::Value factory;
  };
  void add(ptp::Property property);
  template <class Number>
  [[nodiscard]] double number(ptp::PropertyCode code) const;

  std::map<ptp::PropertyCode, Entry> entries_;
};

}  // namespace bodyscan::simulator
