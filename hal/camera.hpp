#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bodyscan {

// Who a camera is, and what keeps it from scanning.
struct CameraIdentity {
  std::string model;                  // "D5000"
  std::string serial;                 // empty where it does not tell
  std::vector<std::string> problems;  // for a technician: "the mode dial is not on M"
};

struct CameraSettings {
  int exposure_us = 50'000;
  int iso = 200;
  double aperture = 8;  // f-number
  Size picture;         // 0 x 0: the largest there is

  friend bool operator==(const CameraSettings&, const CameraSettings&) = default;
};

// A picture file as the camera delivers it: JPEG or PNG.
struct Photograph {
  std::vector<std::byte> file;
  std::int64_t exposure_end_us = 0;  // CLOCK_MONOTONIC, when the shutter was seen closed
};

// A camera that photographs the projected patterns. States:
//
//   closed --open--> ready --expose--> exposed --fetch--> ready
//
// `close` is legal in every state. A device that was lost answers every call but `open` and `close` with an
// error of kind `device`, within two seconds of the exposure's end, and may be opened again. A call in the
// wrong state is a device error that names the state and the one needed. Not thread-safe.
class Camera {
 public:
  Camera() = default;
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;
  virtual ~Camera() = default;

  virtual Expected<CameraIdentity> open() = 0;
  // Sets everything a scan needs and answers what the camera says it has set: the nearest exposure, ISO and
  // aperture there are.
  virtual Expected<CameraSettings> configure(const CameraSettings& wanted) = 0;
  // Returns when the shutter has closed: the next pattern may be shown while `fetch` waits for the picture.
  virtual Expected<void> expose() = 0;
  virtual Expected<Photograph> fetch() = 0;
  // A small picture of what the camera sees now, for people.
  virtual Expected<Photograph> preview() = 0;
  virtual void close() = 0;
};

}  // namespace bodyscan
