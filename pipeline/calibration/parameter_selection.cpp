#include "pipeline/calibration/parameter_selection.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>

namespace bodyscan {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// A group stays where its departure from the defaults is this significant: chi squared a parameter, about the
// logarithm of the number of residuals (the Bayesian information criterion).
constexpr double min_chi_squared = 10;

using Group = std::vector<int>;

// In the order in which they are given up where they are equally insignificant.
std::vector<Group> droppable_groups() {
  std::vector<Group> groups;
  for (const auto of : {&projector_parameter, &camera_parameter}) {
    groups.push_back({of(LensParameter::k3)});
    groups.push_back({of(LensParameter::p1), of(LensParameter::p2)});
    groups.push_back({of(LensParameter::k2)});
    groups.push_back({of(LensParameter::aspect)});
    groups.push_back({of(LensParameter::k1)});
  }
  groups.push_back({projector_parameter(LensParameter::cx)});
  groups.push_back({camera_parameter(LensParameter::cx), camera_parameter(LensParameter::cy)});
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

bool is_free(const ParameterMask& mask, const Group& group) {
  return std::ranges::all_of(group, [&](int p) { return mask[static_cast<std::size_t>(p)]; });
}

// Position among the free parameters.
Eigen::Index position(const ParameterMask& mask, int parameter) {
  Eigen::Index before = 0;
  for (int i = 0; i < parameter; ++i) before += mask[static_cast<std::size_t>(i)] ? 1 : 0;
  return before;
}

// Chi squared a parameter of a group's departure from its defaults.
double significance(const Group& group, const ParameterMask& mask, const Calibration& calibration,
                    const MatrixXd& covariance) {
  const auto size = static_cast<Eigen::Index>(group.size());
  VectorXd departure(size);
  MatrixXd block(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const int parameter = group[static_cast<std::size_t>(i)];
    departure[i] = parameter_value(calibration, parameter) - default_of(parameter, calibration);
    for (Eigen::Index k = 0; k < size; ++k)
      block(i, k) = covariance(position(mask, parameter), position(mask, group[static_cast<std::size_t>(k)]));
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

Adjustment adjust_supported(AdjustmentProblem& problem, const RigEstimate& start) {
  const std::vector<Group> groups = droppable_groups();
  Adjustment fit = adjust(problem, start);
  for (;;) {
    const MatrixXd covariance = covariance_of(fit);
    const Group* weakest = nullptr;
    double least = min_chi_squared;
    for (const Group& group : groups) {
      if (!is_free(problem.free, group)) continue;
      const double chi_squared = significance(group, problem.free, fit.rig.calibration, covariance);
      if (chi_squared >= least) continue;
      least = chi_squared;
      weakest = &group;
    }
    if (weakest == nullptr) return fit;
    RigEstimate next = fit.rig;
    for (const int parameter : *weakest) {
      const double change =
          default_of(parameter, next.calibration) - parameter_value(next.calibration, parameter);
      next.calibration = moved(next.calibration, parameter, change);
      problem.free.reset(static_cast<std::size_t>(parameter));
    }
    fit = adjust(problem, next);
  }
}

}  // namespace bodyscan
