#include "pipeline/calibration/pose_agreement.hpp"

#include "pipeline/base/median.hpp"
#include "pipeline/base/number_text.hpp"
#include "pipeline/calibration/initial_guess.hpp"
#include "pipeline/calibration/square_check.hpp"

#include <algorithm>
#include <cmath>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr double suspicious = 1.7;  // times the poses' median misfit
constexpr double other_board_percent = 1.5;
constexpr double outlier_sigmas = 6;
constexpr double usual_pair_px = 0.25;  // in the projector, of good pictures
constexpr double usual_capture_px = 0.1;

// Without single false corners: lengths far beyond what the median of all would let expect.
double root_mean_square(const std::vector<Vector2d>& residuals, std::size_t begin, std::size_t end) {
  std::vector<double> lengths;
  for (std::size_t k = begin; k < end; ++k) lengths.push_back(residuals[k].norm());
  const double limit = outlier_sigmas * median(lengths) / std::sqrt(2 * std::log(2.0));
  double sum = 0;
  std::size_t count = 0;
  for (const double length : lengths) {
    if (length > limit) continue;
    sum += length * length;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

PoseMisfit misfit_at(const AdjustmentProblem& problem, const Calibration& calibration,
                     const RigidTransform& camera_from_board, std::size_t pose) {
  std::vector<Vector2d> residuals;
  const PoseObservation& seen = problem.poses[pose];
  predict_residuals(calibration, camera_from_board, problem.board, seen, residuals);
  return {root_mean_square(residuals, 0, camera_count(seen)),
          root_mean_square(residuals, camera_count(seen), residuals.size()), camera_from_board};
}

// Medians over the other poses that are used; the projector's over those of its kind, and where there are
// none as large as that kind may be.
PoseMisfit typical_misfit(const AdjustmentProblem& problem, const Adjustment& fit, std::size_t pose) {
  std::vector<double> camera;
  std::vector<double> projector;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    if (!problem.used[i] || i == pose) continue;
    const PoseMisfit misfit = misfit_at(problem, fit.rig.calibration, fit.rig.camera_from_board[i], i);
    camera.push_back(misfit.camera_px);
    if (is_pair(problem.poses[i]) == is_pair(problem.poses[pose])) projector.push_back(misfit.projector_px);
  }
  if (projector.empty()) projector.push_back(is_pair(problem.poses[pose]) ? usual_pair_px : usual_capture_px);
  return {median(camera), median(projector), {}};
}

double ratio(const PoseMisfit& misfit, const PoseMisfit& typical) {
  return std::max(misfit.camera_px / std::max(typical.camera_px, least_misfit_px),
                  misfit.projector_px / std::max(typical.projector_px, least_misfit_px));
}

// Of the printed corners about the flat board that fits them best, whatever the projector says.
double camera_misfit_alone(const AdjustmentProblem& problem, const Adjustment& fit, std::size_t pose) {
  std::vector<PoseObservation> only{problem.poses[pose]};
  only[0].in_projector.clear();
  only[0].projected.clear();
  const AdjustmentProblem alone{problem.board, only, {true}, {}};
  Adjustment start = fit;
  start.rig.camera_from_board = {fit.rig.camera_from_board[pose]};
  return misfit_of_pose(alone, start, 0).camera_px;
}

std::string reason_of(const AdjustmentProblem& problem, const Adjustment& without, const PoseMisfit& misfit,
                      const PoseMisfit& typical, std::size_t pose) {
  const SideFigures sides =
      figures_of(triangulate_board(without.rig.calibration, problem.board, problem.poses[pose]).sides);
  const double error_percent = sides.error_percent.value_or(0);
  if (std::abs(error_percent) > other_board_percent && sides.spread_percent < other_board_percent)
    return "its squares measure " + fixed_text(problem.board.square_mm * (1 + error_percent / 100), 2) +
           " mm, not " + fixed_text(problem.board.square_mm, 2) +
           ": another board, or the board moved between the pictures";
  const double alone_px = camera_misfit_alone(problem, without, pose);
  if (alone_px > disagreeing * typical.camera_px)
    return "its printed corners lie " + fixed_text(alone_px, 2) + " px off a flat board (" +
           fixed_text(typical.camera_px, 2) + " px in other poses): bent, blurred, or another board";
  return "camera and projector disagree by " + fixed_text(misfit.projector_px, 2) + " px (" +
         fixed_text(typical.projector_px, 2) + " px in other poses): the board moved " +
         (is_pair(problem.poses[pose]) ? "between the pictures, or the projector showed something else"
                                       : "during the sequence");
}

}  // namespace

bool is_pair(const PoseObservation& pose) {
  return !pose.projected.empty();
}

PoseMisfit misfit_of_pose(const AdjustmentProblem& problem, const Adjustment& fit, std::size_t pose) {
  AdjustmentProblem alone{problem.board, problem.poses, std::vector<bool>(problem.poses.size(), false), {}};
  alone.used[pose] = true;
  RigEstimate start = fit.rig;
  if (const auto guess = guess_board(problem.board, problem.poses[pose], start.calibration.camera))
    start.camera_from_board[pose] = *guess;
  const Adjustment fitted = adjust(alone, start);
  return misfit_at(problem, fitted.rig.calibration, fitted.rig.camera_from_board[pose], pose);
}

double surprise_of(const AdjustmentProblem& problem, const Adjustment& without, std::size_t pose,
                   const PoseMisfit& misfit, const PoseMisfit& typical) {
  // The residuals' expected squares, in variances: their own, and what the devices' uncertainty adds, at
  // worst all of it to one device.
  const PoseObservation& seen = problem.poses[pose];
  const auto own = 2 * static_cast<double>(std::min(camera_count(seen), projector_count(seen)));
  const double added =
      (covariance_of(without.information) *
       information_of_pose(problem, without.rig.calibration, misfit.camera_from_board, seen, without.sigmas))
          .trace();
  return ratio(misfit, typical) / std::sqrt(1 + std::max(0.0, added) / std::max(own, 1.0));
}

std::vector<std::string> leave_out_disagreeing(AdjustmentProblem& problem, Adjustment& fit, int fewest) {
  std::vector<std::string> reasons(problem.poses.size());
  while (std::ranges::count(problem.used, true) > fewest) {
    double worst_surprise = 0;
    std::size_t worst = 0;
    Adjustment best_without;
    PoseMisfit worst_misfit;
    PoseMisfit worst_typical;
    for (std::size_t i = 0; i < problem.poses.size(); ++i) {
      if (!problem.used[i]) continue;
      const PoseMisfit here = misfit_at(problem, fit.rig.calibration, fit.rig.camera_from_board[i], i);
      if (ratio(here, typical_misfit(problem, fit, i)) < suspicious) continue;
      AdjustmentProblem others = problem;
      others.used[i] = false;
      const Adjustment without = adjust(others, fit.rig);
      const PoseMisfit misfit = misfit_of_pose(problem, without, i);
      const PoseMisfit rest = typical_misfit(problem, without, i);
      const double surprise = surprise_of(problem, without, i, misfit, rest);
      if (surprise <= worst_surprise) continue;
      worst_surprise = surprise;
      worst = i;
      best_without = without;
      worst_misfit = misfit;
      worst_typical = rest;
    }
    if (worst_surprise < disagreeing) break;
    reasons[worst] = reason_of(problem, best_without, worst_misfit, worst_typical, worst);
    problem.used[worst] = false;
    fit = best_without;
  }
  return reasons;
}

}  // namespace bodyscan
