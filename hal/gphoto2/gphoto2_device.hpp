#pragma once

#include "hal/gphoto2/session.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace bodyscan::gphoto2 {

// A picture in libgphoto2's memory.
struct DevicePicture {
  FileHandle file;
  std::int64_t exposure_end_us = 0;
};

// A camera driven through libgphoto2, in the process that may hang or crash with it.
class Gphoto2Device {
 public:
  static Outcome<Gphoto2Device> open(const std::string& port, std::function<void()> on_progress);

  Outcome<Opened> identify();
  Outcome<CameraSettings> configure(const CameraSettings& wanted);
  Outcome<void> expose();
  Outcome<DevicePicture> fetch();
  Outcome<DevicePicture> preview();

 private:
  explicit Gphoto2Device(Session session) : session_(std::move(session)) {}
  Outcome<void> end_live_view();
  Outcome<void> forget_earlier_pictures();
  // The next picture the camera announces within that time, in milliseconds.
  Outcome<std::optional<CameraFilePath>> announced_picture(int patience_ms);

  Session session_;
  std::optional<CameraFilePath> captured_;
  std::int64_t exposure_end_us_ = 0;
  bool live_view_ = false;
};

}  // namespace bodyscan::gphoto2
