#include "pipeline/calibration/fit_report.hpp"

#include "pipeline/base/parallel.hpp"
#include "pipeline/calibration/advice.hpp"
#include "pipeline/calibration/initial_guess.hpp"
#include "pipeline/calibration/pose_agreement.hpp"
#include "pipeline/calibration/rig_uncertainty.hpp"
#include "pipeline/calibration/square_check.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace bodyscan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double noteworthy_share = 0.1;  // of a pose's corners left out
constexpr double degree = std::numbers::pi / 180;

// Root mean square of lengths.
struct Rms {
  double squares = 0;
  std::size_t count = 0;

  void add(double square) {
    squares += square;
    ++count;
  }
  void add(const Rms& other) {
    squares += other.squares;
    count += other.count;
  }
  [[nodiscard]] double value() const {
    return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0;
  }
};

struct DeviceRms {
  Rms fitting;
  Rms all;

  void add(double square, bool fits) {
    all.add(square);
    if (fits) fitting.add(square);
  }
  void add(const DeviceRms& other) {
    fitting.add(other.fitting);
    all.add(other.all);
  }
};

struct PoseRms {
  DeviceRms camera;
  DeviceRms projector;

  [[nodiscard]] std::size_t corners() const { return camera.all.count + projector.all.count; }
  [[nodiscard]] std::size_t left_out() const {
    return corners() - camera.fitting.count - projector.fitting.count;
  }
};

// Where a residual's corner was measured.
Vector2d measured_at(const PoseObservation& pose, std::size_t residual) {
  if (residual < camera_count(pose)) return pose.in_camera[residual].px;
  const std::size_t own = residual - camera_count(pose);
  return own < pose.in_projector.size() ? pose.in_projector[own].px
                                        : pose.projected[own - pose.in_projector.size()].projector_px;
}

PoseRms describe(const AdjustmentProblem& problem, const Adjustment& fit, std::size_t i, PoseReport& report) {
  const PoseObservation& pose = problem.poses[i];
  report.camera_from_board =
      report.used ? fit.rig.camera_from_board[i] : misfit_of_pose(problem, fit, i).camera_from_board;
  report.distance_mm = (report.camera_from_board * problem.board.middle_mm()).norm();
  report.tilt_degrees = std::acos(std::min(1.0, std::abs(report.camera_from_board.rotation(2, 2)))) / degree;
  report.plane_rms_mm = triangulate_board(fit.rig.calibration, problem.board,
                                          report.used ? fitting_corners(pose, fit.weights[i]) : pose)
                            .plane_rms_mm;
  std::vector<Vector2d> residuals;
  predict_residuals(fit.rig.calibration, report.camera_from_board, problem.board, pose, residuals);
  PoseRms rms;
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    const bool in_camera = k < camera_count(pose);
    const bool fits = !report.used || fit.weights[i][k] > 0;
    (in_camera ? report.camera : report.projector)
        .push_back({measured_at(pose, k), residuals[k], report.used && fits});
    (in_camera ? rms.camera : rms.projector).add(residuals[k].squaredNorm(), fits);
  }
  report.camera_rms_px = rms.camera.fitting.value();
  report.projector_rms_px = rms.projector.fitting.value();
  if (static_cast<double>(rms.left_out()) > noteworthy_share * static_cast<double>(rms.corners()))
    report.notes.push_back(std::to_string(rms.left_out()) + " of " + std::to_string(rms.corners()) +
                           " corners do not fit and were left out");
  return rms;
}

// Of small turns after the rotation, and of the length of the translation.
ParameterReport baseline_of(const Calibration& calibration, const ParameterMask& mask,
                            const Eigen::MatrixXd& covariance) {
  const Vector3d& translation = calibration.projector_from_camera.translation;
  const Vector3d direction = translation.normalized();
  const int at = position_in(mask, extrinsic_parameter(3));
  const double variance = direction.dot(covariance.block<3, 3>(at, at) * direction);
  return {"baseline", translation.norm(), std::sqrt(std::max(0.0, variance)), true};
}

std::vector<ParameterReport> parameters_of(const AdjustmentProblem& problem, const SupportedFit& supported) {
  const Calibration& calibration = supported.fit.rig.calibration;
  const Eigen::MatrixXd covariance = covariance_of(supported.fit.information);
  const Eigen::AngleAxisd turn(calibration.projector_from_camera.rotation);
  std::vector<ParameterReport> parameters;
  for (int p = 0; p < shared_parameters; ++p) {
    ParameterReport report{parameter_name(p), parameter_value(calibration, p), {}, false};
    const bool rotation = p >= extrinsic_parameter(0) && p < extrinsic_parameter(3);
    if (rotation) report.value = turn.angle() * turn.axis()[p - extrinsic_parameter(0)] / degree;
    if (problem.free[static_cast<std::size_t>(p)]) {
      const int at = position_in(problem.free, p);
      report.sigma = std::sqrt(std::max(0.0, covariance(at, at))) / (rotation ? degree : 1);
      report.estimated = true;
    }
    const auto fixed = std::ranges::find(supported.fixed, p, &FixedParameter::parameter);
    if (fixed != supported.fixed.end()) report.sigma = fixed->sigma;
    parameters.push_back(report);
  }
  parameters.push_back(baseline_of(calibration, problem.free, covariance));
  return parameters;
}

void append_sides(const AdjustmentProblem& problem, const Calibration& calibration,
                  const PoseObservation& pose, std::vector<double>& sides) {
  const TriangulatedBoard board = triangulate_board(calibration, problem.board, pose);
  sides.insert(sides.end(), board.sides.begin(), board.sides.end());
}

void report_squares(const AdjustmentProblem& problem, const Adjustment& fit, CalibrationReport& report) {
  std::vector<double> sides;
  for (std::size_t i = 0; i < problem.poses.size(); ++i)
    if (problem.used[i])
      append_sides(problem, fit.rig.calibration, fitting_corners(problem.poses[i], fit.weights[i]), sides);
  const SideFigures figures = figures_of(sides);
  report.square_error_percent = figures.error_percent;
  report.square_spread_percent = figures.spread_percent;
}

// Root mean squares over the used poses, the projector's over those of this pose's kind.
PoseMisfit usual_misfit(const AdjustmentProblem& problem, const CalibrationReport& report, std::size_t pose) {
  Rms alike;
  for (std::size_t i = 0; i < problem.poses.size(); ++i)
    if (problem.used[i] && is_pair(problem.poses[i]) == is_pair(problem.poses[pose]))
      alike.add(report.poses[i].projector_rms_px * report.poses[i].projector_rms_px);
  return {report.camera_rms_px, alike.value(), {}};
}

}  // namespace

CalibrationReport report_of(const AdjustmentProblem& problem, const SupportedFit& supported,
                            const std::vector<std::string>& reasons) {
  const Adjustment& fit = supported.fit;
  const std::vector<std::string> repeated = name_repeated(problem, fit.rig.camera_from_board);
  CalibrationReport report;
  PoseRms whole;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    PoseReport pose;
    pose.name = problem.poses[i].name;
    pose.used = problem.used[i];
    pose.reason = reasons[i];
    pose.located = pose.used || guess_board(problem.board, problem.poses[i], fit.rig.calibration.camera);
    if (!repeated[i].empty()) pose.notes.push_back(repeated[i]);
    if (pose.located) {
      const PoseRms rms = describe(problem, fit, i, pose);
      if (pose.used) {
        whole.camera.add(rms.camera);
        whole.projector.add(rms.projector);
      }
    }
    report.poses.push_back(std::move(pose));
  }
  report.camera_rms_px = whole.camera.fitting.value();
  report.projector_rms_px = whole.projector.fitting.value();
  report.all_camera_rms_px = whole.camera.all.value();
  report.all_projector_rms_px = whole.projector.all.value();
  report.corners = static_cast<int>(whole.corners());
  report.corners_left_out = static_cast<int>(whole.left_out());
  Rms joint = whole.camera.fitting;
  joint.add(whole.projector.fitting);
  report.joint_rms_px = joint.value();
  report_squares(problem, fit, report);
  report.parameters = parameters_of(problem, supported);
  if (problem.free[static_cast<std::size_t>(camera_parameter(LensParameter::focal))]) {
    report.relative_uncertainty = relative_uncertainty(problem.free, fit.rig.calibration, fit.information);
    report.verdict = verdict_on(*report.relative_uncertainty);
  }
  return report;
}

double report_leave_one_out(const AdjustmentProblem& problem, const Adjustment& fit,
                            CalibrationReport& report) {
  if (std::ranges::count(problem.used, true) < 2) return 0;
  struct Left {
    PoseMisfit misfit;
    std::vector<double> sides;
    double surprise = 0;
  };
  std::vector<Left> left(problem.poses.size());
  parallel_for(0, static_cast<int>(left.size()), 1, [&](int first, int) {
    const auto i = static_cast<std::size_t>(first);
    if (!problem.used[i]) return;
    AdjustmentProblem others = problem;
    others.used[i] = false;
    const Adjustment without = adjust(others, fit.rig);
    left[i].misfit = misfit_of_pose(problem, without, i);
    left[i].surprise = surprise_of(problem, without, i, left[i].misfit, usual_misfit(problem, report, i));
    append_sides(problem, without.rig.calibration, fitting_corners(problem.poses[i], fit.weights[i]),
                 left[i].sides);
  });
  Rms camera;
  Rms projector;
  std::vector<double> sides;
  double surprise = 0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!problem.used[i]) continue;
    surprise = std::max(surprise, left[i].surprise);
    camera.add(left[i].misfit.camera_px * left[i].misfit.camera_px);
    projector.add(left[i].misfit.projector_px * left[i].misfit.projector_px);
    sides.insert(sides.end(), left[i].sides.begin(), left[i].sides.end());
  }
  report.leave_one_out_camera_px = camera.value();
  report.leave_one_out_projector_px = projector.value();
  report.leave_one_out_square_error_percent = figures_of(sides).error_percent;
  return surprise;
}

}  // namespace bodyscan
