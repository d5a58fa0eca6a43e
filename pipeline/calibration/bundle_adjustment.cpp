#include "pipeline/calibration/bundle_adjustment.hpp"

#include "pipeline/base/median.hpp"
#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/Cholesky>

namespace bodyscan {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int max_rounds = 8;       // of weights
constexpr int max_iterations = 60;  // of one round
constexpr double converged = 1e-9;  // relative fall of the cost
constexpr double huber_sigmas = 2.5;
constexpr double outlier_sigmas = 6;
constexpr double min_sigma_px = 1e-3;

std::vector<int> free_parameters(const ParameterMask& mask) {
  std::vector<int> free;
  for (int i = 0; i < shared_parameters; ++i)
    if (mask[static_cast<std::size_t>(i)]) free.push_back(i);
  return free;
}

// One pose's part of the normal equations: shared parameters first, then the board's own.
struct PoseEquations {
  MatrixXd normal;
  VectorXd right;
};

double variance_of(const Adjustment& state, const PoseObservation& pose, std::size_t residual) {
  const double sigma = state.sigmas.of(kind_of(pose, residual));
  return sigma * sigma;
}

double cost_of(const AdjustmentProblem& problem, const Adjustment& state, const RigEstimate& rig) {
  double cost = 0;
  std::vector<Vector2d> residuals;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    if (!problem.used[i]) continue;
    predict_residuals(rig.calibration, rig.camera_from_board[i], problem.board, problem.poses[i], residuals);
    for (std::size_t k = 0; k < residuals.size(); ++k)
      cost += state.weights[i][k] * residuals[k].squaredNorm() / variance_of(state, problem.poses[i], k);
  }
  return cost;
}

// Derivatives of a pose's residuals by central differences, a column a parameter.
MatrixXd derivatives(const AdjustmentProblem& problem, const Calibration& calibration,
                     const RigidTransform& camera_from_board, const PoseObservation& pose,
                     const std::vector<int>& free) {
  const std::size_t count = camera_count(pose) + projector_count(pose);
  MatrixXd result(2 * static_cast<Eigen::Index>(count),
                  static_cast<Eigen::Index>(free.size()) + pose_parameters);
  std::vector<Vector2d> up;
  std::vector<Vector2d> down;
  const auto fill = [&](Eigen::Index column, double step) {
    for (std::size_t k = 0; k < count; ++k)
      result.block<2, 1>(2 * static_cast<Eigen::Index>(k), column) = (up[k] - down[k]) / (2 * step);
  };
  const std::vector<Vector3d> rays = beam_rays(calibration.camera, pose);
  const auto predict = [&](const Calibration& devices, const RigidTransform& board, bool camera_moved,
                           std::vector<Vector2d>& residuals) {
    if (camera_moved)
      predict_residuals(devices, board, problem.board, pose, residuals);
    else
      predict_residuals(devices, board, problem.board, pose, rays, residuals);
  };
  Eigen::Index column = 0;
  for (const int parameter : free) {
    const double step = parameter_step(parameter, calibration);
    const bool camera = parameter < lens_parameters;
    predict(moved(calibration, parameter, step), camera_from_board, camera, up);
    predict(moved(calibration, parameter, -step), camera_from_board, camera, down);
    fill(column++, step);
  }
  for (int parameter = 0; parameter < pose_parameters; ++parameter) {
    const double step = pose_step(parameter);
    predict(calibration, moved(camera_from_board, parameter, step), false, up);
    predict(calibration, moved(camera_from_board, parameter, -step), false, down);
    fill(column++, step);
  }
  return result;
}

PoseEquations equations_of(const AdjustmentProblem& problem, const Adjustment& state, std::size_t i,
                           const std::vector<int>& free) {
  const PoseObservation& pose = problem.poses[i];
  std::vector<Vector2d> residuals;
  predict_residuals(state.rig.calibration, state.rig.camera_from_board[i], problem.board, pose, residuals);
  const MatrixXd jacobian =
      derivatives(problem, state.rig.calibration, state.rig.camera_from_board[i], pose, free);
  VectorXd weights(2 * static_cast<Eigen::Index>(residuals.size()));
  VectorXd values(weights.size());
  PoseEquations equations;
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    const double weight = state.weights[i][k] / variance_of(state, pose, k);
    const auto at = 2 * static_cast<Eigen::Index>(k);
    weights.segment<2>(at).setConstant(weight);
    values.segment<2>(at) = residuals[k];
  }
  equations.normal = jacobian.transpose() * weights.asDiagonal() * jacobian;
  equations.right = -jacobian.transpose() * (weights.asDiagonal() * values);
  return equations;
}

std::vector<PoseEquations> all_equations(const AdjustmentProblem& problem, const Adjustment& state,
                                         const std::vector<int>& free) {
  std::vector<PoseEquations> all(problem.poses.size());
  parallel_for(0, static_cast<int>(all.size()), 1, [&](int first, int) {
    const auto i = static_cast<std::size_t>(first);
    if (problem.used[i]) all[i] = equations_of(problem, state, i, free);
  });
  return all;
}

// A damped step of all free parameters, the board poses eliminated (Schur complement). Nothing where the
// equations are singular.
struct Step {
  VectorXd shared;
  std::vector<VectorXd> boards;
};

std::optional<Step> solve(const AdjustmentProblem& problem, const std::vector<PoseEquations>& equations,
                          Eigen::Index shared, double damping) {
  MatrixXd normal = MatrixXd::Zero(shared, shared);
  VectorXd right = VectorXd::Zero(shared);
  Step step;
  step.boards.resize(equations.size());
  std::vector<MatrixXd> from_shared(equations.size());  // boards' change a shared parameter's change
  std::vector<VectorXd> alone(equations.size());
  const auto damped = [&](MatrixXd block) {
    block.diagonal() *= 1 + damping;
    block.diagonal().array() += 1e-12;
    return block;
  };
  for (std::size_t i = 0; i < equations.size(); ++i) {
    if (!problem.used[i]) continue;
    const MatrixXd& all = equations[i].normal;
    normal += all.topLeftCorner(shared, shared);
    right += equations[i].right.head(shared);
    if (problem.boards_fixed) continue;
    const Eigen::LDLT<MatrixXd> board(damped(all.bottomRightCorner(pose_parameters, pose_parameters)));
    if (board.info() != Eigen::Success) return std::nullopt;
    from_shared[i] = MatrixXd(pose_parameters, shared);
    if (shared > 0) from_shared[i] = board.solve(all.bottomLeftCorner(pose_parameters, shared));
    alone[i] = board.solve(equations[i].right.tail(pose_parameters));
  }
  normal = damped(normal);
  for (std::size_t i = 0; i < equations.size(); ++i) {
    if (!problem.used[i] || problem.boards_fixed) continue;
    const auto coupling = equations[i].normal.topRightCorner(shared, pose_parameters);
    normal -= coupling * from_shared[i];
    right -= coupling * alone[i];
  }
  if (shared > 0) {
    const Eigen::LDLT<MatrixXd> solver(normal);
    if (solver.info() != Eigen::Success || !solver.isPositive()) return std::nullopt;
    step.shared = solver.solve(right);
    if (!step.shared.allFinite()) return std::nullopt;
  } else {
    step.shared = VectorXd(0);
  }
  for (std::size_t i = 0; i < equations.size(); ++i)
    if (problem.used[i] && !problem.boards_fixed) step.boards[i] = alone[i] - from_shared[i] * step.shared;
  return step;
}

RigEstimate stepped(const AdjustmentProblem& problem, const RigEstimate& rig, const Step& step,
                    const std::vector<int>& free) {
  RigEstimate next = rig;
  for (std::size_t k = 0; k < free.size(); ++k)
    next.calibration = moved(next.calibration, free[k], step.shared[static_cast<Eigen::Index>(k)]);
  for (std::size_t i = 0; i < next.camera_from_board.size(); ++i) {
    if (!problem.used[i] || problem.boards_fixed) continue;
    RigidTransform& board = next.camera_from_board[i];
    board.rotation = rotation_of(step.boards[i].head<3>()) * board.rotation;
    board.translation += step.boards[i].tail<3>();
  }
  return next;
}

// Information about the shared parameters when the board's own are not known.
MatrixXd marginalised(const MatrixXd& all, Eigen::Index shared) {
  if (shared == 0) return {};
  return all.topLeftCorner(shared, shared) - all.topRightCorner(shared, pose_parameters) *
                                                 all.bottomRightCorner(pose_parameters, pose_parameters)
                                                     .ldlt()
                                                     .solve(all.bottomLeftCorner(pose_parameters, shared));
}

// Converges with the weights as they are.
void converge(const AdjustmentProblem& problem, Adjustment& state, const std::vector<int>& free) {
  double damping = 1e-3;
  double cost = cost_of(problem, state, state.rig);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const std::vector<PoseEquations> equations = all_equations(problem, state, free);
    bool better = false;
    double fall = 0;
    while (!better && damping < 1e12) {
      const auto step = solve(problem, equations, static_cast<Eigen::Index>(free.size()), damping);
      if (step) {
        const RigEstimate next = stepped(problem, state.rig, *step, free);
        const double next_cost = cost_of(problem, state, next);
        if (next_cost < cost) {
          better = true;
          fall = cost - next_cost;
          state.rig = next;
          cost = next_cost;
        }
      }
      damping = better ? std::max(damping / 10, 1e-12) : damping * 10;
    }
    if (!better || fall < converged * cost) break;
  }
}

// Standard deviation of one coordinate from the lengths of two-dimensional residuals: their median is
// sqrt(2 ln 2) times it.
double robust_sigma(const std::vector<double>& lengths) {
  return std::max(median(lengths) / std::sqrt(2 * std::log(2.0)), min_sigma_px);
}

CornerSigmas sigmas_of(const std::map<CornerKind, std::vector<double>>& lengths) {
  const auto of = [&](CornerKind kind, CornerKind otherwise) {
    auto found = lengths.find(kind);
    if (found == lengths.end()) found = lengths.find(otherwise);
    return found == lengths.end() ? 1 : robust_sigma(found->second);
  };
  return {of(CornerKind::camera, CornerKind::camera), of(CornerKind::captured, CornerKind::projected),
          of(CornerKind::projected, CornerKind::captured)};
}

// New spreads and weights; whether they moved noticeably.
bool reweigh(const AdjustmentProblem& problem, Adjustment& state) {
  std::vector<std::vector<Vector2d>> residuals(problem.poses.size());
  std::map<CornerKind, std::vector<double>> lengths;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    if (!problem.used[i]) continue;
    predict_residuals(state.rig.calibration, state.rig.camera_from_board[i], problem.board, problem.poses[i],
                      residuals[i]);
    for (std::size_t k = 0; k < residuals[i].size(); ++k)
      lengths[kind_of(problem.poses[i], k)].push_back(residuals[i][k].norm());
  }
  const CornerSigmas before = state.sigmas;
  state.sigmas = sigmas_of(lengths);
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    for (std::size_t k = 0; k < residuals[i].size(); ++k) {
      const double sigmas = residuals[i][k].norm() / std::sqrt(variance_of(state, problem.poses[i], k));
      state.weights[i][k] =
          sigmas > outlier_sigmas ? 0 : std::min(1.0, huber_sigmas / std::max(sigmas, 1e-9));
    }
  }
  return std::ranges::any_of(
      std::array{CornerKind::camera, CornerKind::captured, CornerKind::projected},
      [&](CornerKind kind) { return std::abs(state.sigmas.of(kind) / before.of(kind) - 1) > 1e-3; });
}

}  // namespace

Adjustment adjust(const AdjustmentProblem& problem, const RigEstimate& start) {
  const std::vector<int> free = free_parameters(problem.free);
  Adjustment state;
  state.rig = start;
  for (const PoseObservation& pose : problem.poses)
    state.weights.emplace_back(camera_count(pose) + projector_count(pose), 1.0);
  reweigh(problem, state);  // a pose that is far off must not draw the first fit to itself
  for (int round = 0; round < max_rounds; ++round) {
    converge(problem, state, free);
    if (!reweigh(problem, state)) break;
  }
  state.information =
      MatrixXd::Zero(static_cast<Eigen::Index>(free.size()), static_cast<Eigen::Index>(free.size()));
  const auto shared = static_cast<Eigen::Index>(free.size());
  for (const PoseEquations& equations : all_equations(problem, state, free)) {
    if (equations.normal.size() == 0) continue;
    if (problem.boards_fixed)
      state.information += equations.normal.topLeftCorner(shared, shared);
    else
      state.information += marginalised(equations.normal, shared);
  }
  return state;
}

MatrixXd covariance_of(const MatrixXd& information) {
  const Eigen::Index size = information.rows();
  // Scaled to a unit diagonal first: the parameters' units are far apart.
  const VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  return scale.asDiagonal() * scaled.ldlt().solve(MatrixXd::Identity(size, size)) * scale.asDiagonal();
}

MatrixXd information_of_pose(const AdjustmentProblem& problem, const Calibration& calibration,
                             const RigidTransform& camera_from_board, const PoseObservation& pose,
                             const CornerSigmas& sigmas) {
  const std::vector<int> free = free_parameters(problem.free);
  const MatrixXd jacobian = derivatives(problem, calibration, camera_from_board, pose, free);
  VectorXd weights(jacobian.rows());
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    const double sigma = sigmas.of(kind_of(pose, static_cast<std::size_t>(i) / 2));
    weights[i] = 1 / (sigma * sigma);
  }
  return marginalised(jacobian.transpose() * weights.asDiagonal() * jacobian,
                      static_cast<Eigen::Index>(free.size()));
}

}  // namespace bodyscan
