#pragma once

#include "pipeline/calibration/rig_model.hpp"

#include <vector>

#include <Eigen/Core>

namespace bodyscan {

// Weights of the residuals of predict_residuals, pose by pose; 0 leaves one out.
using ResidualWeights = std::vector<std::vector<double>>;

struct AdjustmentProblem {
  const PrintedBoard& board;
  const std::vector<PoseObservation>& poses;
  std::vector<bool> used;     // a pose each
  ParameterMask free;         // shared parameters that are estimated; board poses always are
  bool boards_fixed = false;  // but for this
};

struct Adjustment {
  RigEstimate rig;
  ResidualWeights weights;      // relative to 1 / variance
  CornerSigmas sigmas;          // robust; a kind that is not there has the other one's of the projector
  Eigen::MatrixXd information;  // of the free shared parameters, the board poses marginalised out
};

// Weighted nonlinear least squares (Levenberg and Marquardt) over the free parameters, from `start`, with
// Huber's weights about the robust spread of each kind of corner, and none beyond six standard
// deviations (Huber 1981). Poses not used keep their start.
Adjustment adjust(const AdjustmentProblem& problem, const RigEstimate& start);

// Covariance of the free shared parameters, in the order of their bits, from an information about them.
Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& information);

// Information about the shared parameters that one more pose of the board would add, seen as it would be.
Eigen::MatrixXd information_of_pose(const AdjustmentProblem& problem, const Calibration& calibration,
                                    const RigidTransform& camera_from_board, const PoseObservation& pose,
                                    const CornerSigmas& sigmas);

}  // namespace bodyscan
