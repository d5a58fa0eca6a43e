#include "pipeline/calibration/calibrate.hpp"

#include "pipeline/calibration/advice.hpp"
#include "pipeline/calibration/initial_guess.hpp"
#include "pipeline/calibration/parameter_selection.hpp"
#include "pipeline/calibration/pose_agreement.hpp"
#include "pipeline/calibration/square_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <Eigen/Geometry>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr int fewest_poses = 3;
constexpr double max_focal_uncertainty = 0.1;  // relative: beyond, the poses tell nothing
constexpr double blur_ratio = 2.5;             // times the poses' median: a blurred picture
constexpr double min_blur_px = 2;
constexpr double noteworthy_share = 0.1;  // of a pose's corners left out
constexpr double degree = std::numbers::pi / 180;

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100 * share);
  return text;
}

std::vector<PoseObservation> observations_of(const CalibrationRequest& request) {
  std::vector<PoseObservation> poses;
  for (const CalibrationPose& pose : request.poses) poses.push_back(pose.observation);
  return poses;
}

// Every pose that is not used, with its reason.
std::string bad_poses(const CalibrationRequest& request, const std::vector<std::string>& reasons) {
  std::string text;
  for (std::size_t i = 0; i < request.poses.size(); ++i)
    if (!reasons[i].empty()) text += "\n  " + request.poses[i].observation.name + ": " + reasons[i];
  return text;
}

tl::unexpected<Error> too_few(const CalibrationRequest& request, const std::vector<std::string>& reasons,
                              std::ptrdiff_t good, int needed) {
  return input_error(
      "at least " + std::to_string(needed) + " good pose" + (needed > 1 ? "s" : "") + " of the board " +
      (needed > 1 ? "are" : "is") + " needed, " + std::to_string(good) + (good == 1 ? " is" : " are") +
      " there; hold the board up at different tilts, places and distances" + bad_poses(request, reasons));
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Pictures whose edges are far softer than the others'.
std::vector<std::string> blurred_poses(const CalibrationRequest& request) {
  std::vector<double> blurs;
  for (const CalibrationPose& pose : request.poses)
    if (pose.failure.empty() && pose.edge_blur_px > 0) blurs.push_back(pose.edge_blur_px);
  const double usual = median(blurs);
  std::vector<std::string> reasons;
  for (const CalibrationPose& pose : request.poses) {
    const bool blurred = pose.failure.empty() && blurs.size() >= fewest_poses &&
                         pose.edge_blur_px > std::max(blur_ratio * usual, min_blur_px);
    char text[96];
    std::snprintf(text, sizeof text, "blurred: its edges are %.1f px soft, %.1f px in other poses",
                  pose.edge_blur_px, usual);
    reasons.push_back(blurred ? text : "");
  }
  return reasons;
}

// Root mean square of lengths.
struct Rms {
  double squares = 0;
  std::size_t count = 0;
  void add(double square) {
    squares += square;
    ++count;
  }
  [[nodiscard]] double value() const {
    return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0;
  }
};

void report_pose(const AdjustmentProblem& problem, const Adjustment& fit, std::size_t i, PoseReport& report,
                 Rms& camera, Rms& projector) {
  const PoseObservation& pose = problem.poses[i];
  report.camera_from_board = fit.rig.camera_from_board[i];
  const Eigen::Vector3d middle(problem.board.square_mm * (problem.board.columns - 1) / 2,
                               problem.board.square_mm * (problem.board.rows - 1) / 2, 0);
  report.distance_mm = (report.camera_from_board * middle).norm();
  report.tilt_degrees = std::acos(std::min(1.0, std::abs(report.camera_from_board.rotation(2, 2)))) / degree;
  report.plane_rms_mm = triangulate_board(fit.rig.calibration, problem.board, pose).plane_rms_mm;
  std::vector<Vector2d> residuals;
  predict_residuals(fit.rig.calibration, report.camera_from_board, problem.board, pose, residuals);
  Rms own_camera;
  Rms own_projector;
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    const bool in_camera = k < camera_count(pose);
    const std::size_t own = k - (in_camera ? 0 : camera_count(pose));
    Vector2d at;
    if (in_camera)
      at = pose.in_camera[own].px;
    else
      at = own < pose.in_projector.size() ? pose.in_projector[own].px
                                          : pose.projected[own - pose.in_projector.size()].projector_px;
    const bool used = report.used && fit.weights[i][k] > 0;
    (in_camera ? report.camera : report.projector).push_back({at, residuals[k], used});
    if (!used) continue;
    const double square = residuals[k].squaredNorm();
    (in_camera ? own_camera : own_projector).add(square);
    (in_camera ? camera : projector).add(square);
  }
  report.camera_rms_px = own_camera.value();
  report.projector_rms_px = own_projector.value();
  const std::size_t left_out = residuals.size() - own_camera.count - own_projector.count;
  if (report.used && report.reason.empty() &&
      static_cast<double>(left_out) > noteworthy_share * static_cast<double>(residuals.size()))
    report.reason = std::to_string(left_out) + " of " + std::to_string(residuals.size()) +
                    " corners do not fit and were left out";
}

std::vector<ParameterReport> report_parameters(const AdjustmentProblem& problem, const Adjustment& fit) {
  const Eigen::MatrixXd covariance = covariance_of(fit);
  std::vector<ParameterReport> parameters;
  const Calibration& calibration = fit.rig.calibration;
  const Eigen::AngleAxisd turn(calibration.projector_from_camera.rotation);
  Eigen::Index position = 0;
  for (int p = 0; p < shared_parameters; ++p) {
    ParameterReport report{parameter_name(p), parameter_value(calibration, p), {}};
    const bool rotation = p >= extrinsic_parameter(0) && p < extrinsic_parameter(3);
    if (rotation) report.value = turn.angle() * turn.axis()[p - extrinsic_parameter(0)] / degree;
    if (problem.free[static_cast<std::size_t>(p)]) {
      report.sigma = std::sqrt(std::max(0.0, covariance(position, position))) / (rotation ? degree : 1);
      ++position;
    }
    parameters.push_back(report);
  }
  return parameters;
}

void report_squares(const AdjustmentProblem& problem, const Adjustment& fit, CalibrationReport& report) {
  std::vector<double> sides;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    if (!problem.used[i]) continue;
    const TriangulatedBoard board = triangulate_board(fit.rig.calibration, problem.board, problem.poses[i]);
    sides.insert(sides.end(), board.sides.begin(), board.sides.end());
  }
  const SideFigures figures = figures_of(sides);
  report.square_error_percent = figures.error_percent;
  report.square_spread_percent = figures.spread_percent;
}

void report_leave_one_out(const AdjustmentProblem& problem, const Adjustment& fit,
                          CalibrationReport& report) {
  if (std::ranges::count(problem.used, true) < fewest_poses) return;
  Rms camera;
  Rms projector;
  std::vector<double> sides;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    if (!problem.used[i]) continue;
    AdjustmentProblem others = problem;
    others.used[i] = false;
    const Adjustment without = adjust(others, fit.rig);
    const PoseMisfit misfit = misfit_of_pose(problem, without, i);
    camera.add(misfit.camera_px * misfit.camera_px);
    projector.add(misfit.projector_px * misfit.projector_px);
    const TriangulatedBoard board =
        triangulate_board(without.rig.calibration, problem.board, problem.poses[i]);
    sides.insert(sides.end(), board.sides.begin(), board.sides.end());
  }
  report.leave_one_out_camera_px = camera.value();
  report.leave_one_out_projector_px = projector.value();
  report.leave_one_out_square_error_percent = figures_of(sides).error_percent;
}

CalibrationReport report_of(const AdjustmentProblem& problem, const Adjustment& fit,
                            const std::vector<std::string>& reasons) {
  CalibrationReport report;
  const std::vector<std::string> repeated = name_repeated(problem, fit.rig.camera_from_board);
  Rms camera;
  Rms projector;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    PoseReport pose;
    pose.name = problem.poses[i].name;
    pose.used = problem.used[i];
    pose.reason = pose.used ? repeated[i] : reasons[i];
    if (!problem.poses[i].in_camera.empty()) report_pose(problem, fit, i, pose, camera, projector);
    report.poses.push_back(std::move(pose));
  }
  report.camera_rms_px = camera.value();
  report.projector_rms_px = projector.value();
  Rms joint = camera;
  joint.squares += projector.squares;
  joint.count += projector.count;
  report.joint_rms_px = joint.value();
  report_squares(problem, fit, report);
  report.parameters = report_parameters(problem, fit);
  return report;
}

// Relative standard deviation of a focal length that the poses leave.
double focal_uncertainty(const AdjustmentProblem& problem, const Adjustment& fit, int parameter) {
  Eigen::Index position = 0;
  for (int p = 0; p < parameter; ++p) position += problem.free[static_cast<std::size_t>(p)] ? 1 : 0;
  const double variance = covariance_of(fit)(position, position);
  return variance >= 0 ? std::sqrt(variance) / parameter_value(fit.rig.calibration, parameter)
                       : max_focal_uncertainty;
}

Expected<CalibrationResult> calibrate_extrinsics(const CalibrationRequest& request,
                                                 AdjustmentProblem& problem,
                                                 std::vector<std::string> reasons) {
  RigEstimate rig{*request.keep_intrinsics, std::vector<RigidTransform>(problem.poses.size())};
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    if (!problem.used[i]) continue;
    const auto pose = guess_board(request.board, problem.poses[i], rig.calibration.camera);
    if (!pose) return input_error(problem.poses[i].name + ": its corners do not determine a plane");
    rig.camera_from_board[i] = *pose;
  }
  const auto extrinsics = guess_extrinsics(request.board, problem.poses, problem.used, rig);
  if (!extrinsics) return tl::unexpected(extrinsics.error());
  rig.calibration.projector_from_camera = *extrinsics;
  problem.free = extrinsics_only();
  Adjustment fit = adjust(problem, rig);
  const std::vector<std::string> disagreeing = leave_out_disagreeing(problem, fit);
  for (std::size_t i = 0; i < reasons.size(); ++i)
    if (reasons[i].empty()) reasons[i] = disagreeing[i];
  return CalibrationResult{fit.rig.calibration, report_of(problem, fit, reasons)};
}

}  // namespace

Expected<CalibrationResult> calibrate(const CalibrationRequest& request) {
  const std::vector<PoseObservation> poses = observations_of(request);
  AdjustmentProblem problem{request.board, poses, {}, {}};
  std::vector<std::string> reasons;
  const std::vector<std::string> blurred = blurred_poses(request);
  for (std::size_t i = 0; i < request.poses.size(); ++i) {
    reasons.push_back(request.poses[i].failure.empty() ? blurred[i] : request.poses[i].failure);
    problem.used.push_back(reasons.back().empty());
  }
  const std::ptrdiff_t seen = std::ranges::count(problem.used, true);
  if (request.keep_intrinsics) {
    if (seen < 1) return too_few(request, reasons, seen, 1);
    return calibrate_extrinsics(request, problem, reasons);
  }
  if (seen < fewest_poses) return too_few(request, reasons, seen, fewest_poses);

  const Expected<RigEstimate> guess =
      guess_rig(request.board, poses, problem.used, request.camera, request.projector);
  if (!guess) return tl::unexpected(guess.error());
  problem.free = all_parameters(static_cast<int>(seen));
  Adjustment fit = adjust(problem, *guess);
  const std::vector<std::string> disagreeing = leave_out_disagreeing(problem, fit);
  for (std::size_t i = 0; i < reasons.size(); ++i)
    if (reasons[i].empty()) reasons[i] = disagreeing[i];
  fit = adjust_supported(problem, fit.rig);

  for (const int parameter :
       {camera_parameter(LensParameter::focal), projector_parameter(LensParameter::focal)}) {
    const double uncertainty = focal_uncertainty(problem, fit, parameter);
    if (uncertainty >= max_focal_uncertainty) {
      std::string message = "the poses are too much alike: " + parameter_name(parameter) + " is known to " +
                            percent(uncertainty) + " only";
      for (const std::string& line : advise(problem, fit)) message += "\n  " + line;
      return input_error(message + bad_poses(request, reasons));
    }
  }
  CalibrationResult result{fit.rig.calibration, report_of(problem, fit, reasons)};
  report_leave_one_out(problem, fit, result.report);
  result.report.advice = advise(problem, fit);
  return result;
}

}  // namespace bodyscan
