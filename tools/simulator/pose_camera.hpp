#pragma once

#include "tools/simulator/renderer.hpp"
#include "tools/simulator/session_poses.hpp"

#include <memory>

namespace bodyscan::simulator {

// Takes the pictures of one pose of a session. All share the traced rays, unless board or light change after
// the first.
class PoseCamera {
 public:
  // `number` keeps the noise of the session's poses apart. Of the options, the pose sets light and lens blur.
  static Expected<PoseCamera> make(const Calibration& calibration, const SessionPose& pose, int number,
                                   const RenderOptions& options);

  // Picture `index` (0: the first) while the projector shows a Pattern or a ProjectedBoard. May be called
  // from several threads.
  template <class Shown>
  [[nodiscard]] ColorImage8 take(const Shown& shown, int index) const {
    return (index == 0 || second_ == nullptr ? *first_ : *second_).renderer.frame(shown, index);
  }

 private:
  struct Setup {
    std::unique_ptr<Scene> scene;
    Renderer renderer;
  };
  static Expected<Setup> set_up(const Calibration& calibration, const SessionPose& pose,
                                const RigidTransform& camera_from_board, const RenderOptions& options);

  PoseCamera() = default;

  std::unique_ptr<Setup> first_;
  std::unique_ptr<Setup> second_;  // null: as the first
};

}  // namespace bodyscan::simulator
