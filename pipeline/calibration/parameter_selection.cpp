#include "pipeline/calibration/parameter_selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>

namespace bodyscan {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// A group stays where its departure from the defaults is this significant: chi squared a parameter, about the
// logarithm of the number of residuals (the Bayesian information criterion).
constexpr double min_chi_squared = 10;

struct Group {
  std::vector<int> parameters;
  std::optional<int> after;  // a higher term of the same series, fixed before
};

// In the order in which they are given up where they are equally insignificant.
std::vector<Group> droppable_groups() {
  std::vector<Group> groups;
  for (const auto of : {&projector_parameter, &camera_parameter}) {
    groups.push_back({{of(LensParameter::k3)}, {}});
    groups.push_back({{of(LensParameter::p1), of(LensParameter::p2)}, {}});
    groups.push_back({{of(LensParameter::k2)}, of(LensParameter::k3)});
    groups.push_back({{of(LensParameter::aspect)}, {}});
    groups.push_back({{of(LensParameter::k1)}, of(LensParameter::k2)});
  }
  groups.push_back({{projector_parameter(LensParameter::cx)}, {}});
  groups.push_back({{camera_parameter(LensParameter::cx), camera_parameter(LensParameter::cy)}, {}});
  return groups;
}

double default_of(int parameter, const Calibration& calibration) {
  const Lens& lens = parameter < lens_parameters ? calibration.camera : calibration.projector;
  switch (static_cast<LensParameter>(parameter % lens_parameters)) {
    case LensParameter::aspect:
      return 1;
    case LensParameter::cx:
      return (lens.size.width - 1) / 2.0;
    case LensParameter::cy:
      return (lens.size.height - 1) / 2.0;
    default:
      return 0;
  }
}

// How far from its default a parameter may lie in a lens worth calibrating. Data that leave more room than
// that do not determine it, whatever they say by chance.
double plausible_departure(int parameter, const Calibration& calibration) {
  const Lens& lens = parameter < lens_parameters ? calibration.camera : calibration.projector;
  switch (static_cast<LensParameter>(parameter % lens_parameters)) {
    case LensParameter::aspect:
    case LensParameter::p1:
    case LensParameter::p2:
      return 0.02;
    case LensParameter::cx:
      return 0.1 * lens.size.width;
    case LensParameter::cy:
      return 0.1 * lens.size.height;
    case LensParameter::k1:
      return 0.5;
    default:
      return 1;
  }
}

bool is_free(const ParameterMask& mask, int parameter) {
  return mask[static_cast<std::size_t>(parameter)];
}

bool is_droppable(const ParameterMask& mask, const Group& group) {
  return std::ranges::all_of(group.parameters, [&](int p) { return is_free(mask, p); }) &&
         !(group.after && is_free(mask, *group.after));
}

// Chi squared a parameter of a group's departure from its defaults; 0 where the data do not determine it.
double significance(const std::vector<int>& group, const ParameterMask& mask, const Calibration& calibration,
                    const MatrixXd& covariance) {
  const auto size = static_cast<Eigen::Index>(group.size());
  VectorXd departure(size);
  MatrixXd block(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const int parameter = group[static_cast<std::size_t>(i)];
    const int at = position_in(mask, parameter);
    if (std::sqrt(covariance(at, at)) > plausible_departure(parameter, calibration)) return 0;
    departure[i] = parameter_value(calibration, parameter) - default_of(parameter, calibration);
    for (Eigen::Index k = 0; k < size; ++k)
      block(i, k) =
          covariance(position_in(mask, parameter), position_in(mask, group[static_cast<std::size_t>(k)]));
  }
  const double chi_squared = departure.dot(block.ldlt().solve(departure));
  return chi_squared >= 0 ? chi_squared / static_cast<double>(size) : 0;
}

}  // namespace

ParameterMask all_parameters(int poses) {
  ParameterMask mask;
  mask.set();
  if (poses < 5) {
    mask.reset(static_cast<std::size_t>(camera_parameter(LensParameter::k3)));
    mask.reset(static_cast<std::size_t>(projector_parameter(LensParameter::k3)));
  }
  return mask;
}

ParameterMask extrinsics_only() {
  ParameterMask mask;
  for (int i = 0; i < 6; ++i) mask.set(static_cast<std::size_t>(extrinsic_parameter(i)));
  return mask;
}

SupportedFit adjust_supported(AdjustmentProblem& problem, const RigEstimate& start) {
  const std::vector<Group> groups = droppable_groups();
  SupportedFit result{adjust(problem, start), {}};
  for (;;) {
    const MatrixXd covariance = covariance_of(result.fit.information);
    const Group* weakest = nullptr;
    double least = min_chi_squared;
    for (const Group& group : groups) {
      if (!is_droppable(problem.free, group)) continue;
      const double chi_squared =
          significance(group.parameters, problem.free, result.fit.rig.calibration, covariance);
      if (chi_squared >= least) continue;
      least = chi_squared;
      weakest = &group;
    }
    if (weakest == nullptr) return result;
    RigEstimate next = result.fit.rig;
    for (const int parameter : weakest->parameters) {
      const int at = position_in(problem.free, parameter);
      result.fixed.push_back({parameter, std::sqrt(std::max(0.0, covariance(at, at)))});
      const double change =
          default_of(parameter, next.calibration) - parameter_value(next.calibration, parameter);
      next.calibration = moved(next.calibration, parameter, change);
    }
    for (const int parameter : weakest->parameters) problem.free.reset(static_cast<std::size_t>(parameter));
    result.fit = adjust(problem, next);
  }
}

}  // namespace bodyscan
