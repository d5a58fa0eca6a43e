#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/calibration/bundle_adjustment.hpp"

#include <optional>
#include <vector>

namespace bodyscan {

// A rig to start the adjustment from: the camera by focal length alone (the one of a range whose planes fit
// best, then adjusted), each board's pose from its homography, and the projector likewise as an inverse
// camera whose principal point may lie far off the middle (lens shift). Error: the poses allow none.
Expected<RigEstimate> guess_rig(const PrintedBoard& board, const std::vector<PoseObservation>& poses,
                                const std::vector<bool>& used, Size camera, Size projector);

// A board's pose from its corners in the camera alone.
std::optional<RigidTransform> guess_board(const PrintedBoard& board, const PoseObservation& pose,
                                          const Lens& camera);

// The projector's pose for known lenses and board poses.
Expected<RigidTransform> guess_extrinsics(const PrintedBoard& board,
                                          const std::vector<PoseObservation>& poses,
                                          const std::vector<bool>& used, const RigEstimate& rig);

}  // namespace bodyscan
