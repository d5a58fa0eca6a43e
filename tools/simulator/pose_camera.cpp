#include "tools/simulator/pose_camera.hpp"

#include "tools/simulator/subjects.hpp"

#include <utility>

namespace bodyscan::simulator {

Expected<PoseCamera::Setup> PoseCamera::set_up(const Calibration& calibration, const SessionPose& pose,
                                               const RigidTransform& camera_from_board,
                                               const RenderOptions& options) {
  auto scene =
      std::make_unique<Scene>(place_subject(calibration, make_printed_board(pose.sheet), camera_from_board));
  Expected<Renderer> renderer = Renderer::make(*scene, options);
  if (!renderer) return tl::unexpected(renderer.error());
  return Setup{std::move(scene), std::move(*renderer)};
}

Expected<PoseCamera> PoseCamera::make(const Calibration& calibration, const SessionPose& pose, int number,
                                      const RenderOptions& options) {
  RenderOptions own = options;
  own.seed += static_cast<std::uint64_t>(number) << 32;
  own.lens_blur = pose.lens_blur;
  own.light = pose.first_light;
  PoseCamera camera;
  Expected<Setup> first = set_up(calibration, pose, pose.first_camera_from_board, own);
  if (!first) return tl::unexpected(first.error());
  camera.first_ = std::make_unique<Setup>(std::move(*first));
  const RigidTransform& before = pose.first_camera_from_board;
  const RigidTransform& after = pose.second_camera_from_board;
  if (pose.second_light == pose.first_light && after.rotation == before.rotation &&
      after.translation == before.translation)
    return camera;
  own.light = pose.second_light;
  Expected<Setup> second = set_up(calibration, pose, after, own);
  if (!second) return tl::unexpected(second.error());
  camera.second_ = std::make_unique<Setup>(std::move(*second));
  return camera;
}

}  // namespace bodyscan::simulator
