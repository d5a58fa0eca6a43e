#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace bodyscan {

struct DisplayMode {
  Size size;
  double refresh_hz = 60;

  friend bool operator==(const DisplayMode&, const DisplayMode&) = default;
};

// A place where a projector can be plugged in, and what is there.
struct ProjectorOutput {
  std::string connector;  // "HDMI-A-1"
  std::string edid;  // "NEC 4a21 1234567": maker, product, serial number; empty where nothing is plugged in
  std::vector<DisplayMode> modes;  // preferred first; empty where nothing is plugged in
};

// Which projector to use, and how.
struct ProjectorChoice {
  std::string connector;  // empty: the only output that fits
  std::string edid;       // empty: whatever is plugged in
  DisplayMode mode;       // the calibrated one; any other is refused
};

// "1024 x 768 at 60 Hz"; for messages.
std::string describe(const DisplayMode& mode);

// A projector that shows patterns. States: closed --open--> dark or showing. `close` is legal in every state
// and leaves the picture dark where the device still answers. A projector that was unplugged or changed its
// mode answers every call but `open` and `close` with an error of kind `device`. Not thread-safe.
class Projector {
 public:
  Projector() = default;
  Projector(const Projector&) = delete;
  Projector& operator=(const Projector&) = delete;
  virtual ~Projector() = default;

  // Sets the mode and shows black.
  virtual Expected<void> open() = 0;
  [[nodiscard]] virtual DisplayMode mode() const = 0;
  // Of the mode's size. Returns once the page flip is done, with its time (us, CLOCK_MONOTONIC); what the
  // projector itself adds until the light is on the wall is the caller's to wait.
  virtual Expected<std::int64_t> show(const GrayImage8& picture) = 0;
  virtual void close() = 0;
};

}  // namespace bodyscan
