#pragma once

#include "pipeline/calibration/bundle_adjustment.hpp"

#include <vector>

namespace bodyscan {

// Everything that two devices have; the highest distortion term only with five poses and more.
ParameterMask all_parameters(int poses);

// The projector's pose alone.
ParameterMask extrinsics_only();

struct FixedParameter {
  int parameter = 0;
  double sigma = 0;  // its standard deviation when it was fixed
};

struct SupportedFit {
  Adjustment fit;
  std::vector<FixedParameter> fixed;
};

// Adjusts with problem.free, then fixes at their defaults, one group after the other, the parameters that the
// data cannot tell from these (Wald's test): equal focal lengths, the principal point in the middle, no
// distortion, its higher terms before the lower. Focal lengths, the projector's cy (lens shift) and its pose
// stay. problem.free is what remains.
SupportedFit adjust_supported(AdjustmentProblem& problem, const RigEstimate& start);

}  // namespace bodyscan
