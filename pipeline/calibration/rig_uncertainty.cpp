#include "pipeline/calibration/rig_uncertainty.hpp"

#include "pipeline/calibration/bundle_adjustment.hpp"

#include <algorithm>
#include <cmath>

namespace bodyscan {
namespace {

constexpr double good = 0.001;
constexpr double usable = 0.003;

}  // namespace

double relative_uncertainty(const ParameterMask& free, const Calibration& calibration,
                            const Eigen::MatrixXd& information) {
  const Eigen::MatrixXd covariance = covariance_of(information);
  double sum = 0;
  for (const int parameter :
       {camera_parameter(LensParameter::focal), projector_parameter(LensParameter::focal)}) {
    const int at = position_in(free, parameter);
    const double value = parameter_value(calibration, parameter);
    sum += covariance(at, at) / (value * value);
  }
  const int at = position_in(free, extrinsic_parameter(3));
  const Eigen::Vector3d& translation = calibration.projector_from_camera.translation;
  const Eigen::Vector3d direction = translation.normalized();
  sum += direction.dot(covariance.block<3, 3>(at, at) * direction) / translation.squaredNorm();
  return std::sqrt(std::max(sum, 0.0));
}

std::string verdict_on(double relative_uncertainty) {
  if (relative_uncertainty <= good) return "good";
  if (relative_uncertainty <= usable) return "usable; more poses would make it good";
  return "poor; shoot more poses";
}

}  // namespace bodyscan
