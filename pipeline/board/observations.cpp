#include "pipeline/board/observations.hpp"

namespace bodyscan {

PoseObservation fitting_corners(const PoseObservation& pose, const std::vector<double>& weights) {
  PoseObservation fitting{pose.name, {}, {}, {}};
  auto weight = weights.begin();
  for (const SeenCorner& seen : pose.in_camera)
    if (*weight++ > 0) fitting.in_camera.push_back(seen);
  for (const SeenCorner& seen : pose.in_projector)
    if (*weight++ > 0) fitting.in_projector.push_back(seen);
  for (const Beam& beam : pose.projected)
    if (*weight++ > 0) fitting.projected.push_back(beam);
  return fitting;
}

}  // namespace bodyscan
