#pragma once

#include "pipeline/calibration/rig_model.hpp"

#include <string>

#include <Eigen/Core>

namespace bodyscan {

// What decides how true lengths come out: the relative standard deviations of both focal lengths and of the
// baseline, as the root of their squares' sum. `information` is of the free shared parameters; focal lengths
// and translation are among them.
double relative_uncertainty(const ParameterMask& free, const Calibration& calibration,
                            const Eigen::MatrixXd& information);

// What that is worth, for people: "good", up to 0.1 %, and so on.
std::string verdict_on(double relative_uncertainty);

}  // namespace bodyscan
