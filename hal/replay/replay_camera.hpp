#pragma once

#include "hal/camera.hpp"
#include "hal/replay/capture_folder.hpp"

namespace bodyscan {

// A camera that delivers a capture folder's photographs, one a shot in decode order and then from the
// beginning again: for demonstrations and tests of what uses a camera. It sees no projector.
class ReplayCamera : public Camera {
 public:
  explicit ReplayCamera(CaptureFolder folder);

  Expected<CameraIdentity> open() override;
  // What the folder says of its photographs, whatever is wanted.
  Expected<CameraSettings> configure(const CameraSettings& wanted) override;
  Expected<void> expose() override;
  Expected<Photograph> fetch() override;
  // The white frame.
  Expected<Photograph> preview() override;
  void close() override;

 private:
  enum class State { closed, ready, exposed };
  [[nodiscard]] Expected<void> require(State needed) const;
  [[nodiscard]] Expected<Photograph> photograph(int frame) const;

  CaptureFolder folder_;
  State state_ = State::closed;
  int next_ = 0;
};

}  // namespace bodyscan
