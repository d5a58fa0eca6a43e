#include "pipeline/calibration/calibrate.hpp"

#include "pipeline/base/median.hpp"
#include "pipeline/base/number_text.hpp"
#include "pipeline/calibration/advice.hpp"
#include "pipeline/calibration/calibration_file.hpp"
#include "pipeline/calibration/fit_report.hpp"
#include "pipeline/calibration/initial_guess.hpp"
#include "pipeline/calibration/parameter_selection.hpp"
#include "pipeline/calibration/pose_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr double max_focal_uncertainty = 0.1;  // relative: beyond, the poses tell nothing
constexpr double blur_ratio = 2.5;             // times the poses' median: a blurred picture
constexpr double min_blur_px = 2;
constexpr double max_kept_camera_px = 1;  // of lenses that still hold, if it is not known how they did before
constexpr double max_kept_projector_px = 0.5;
constexpr double kept_ratio = 4;  // times what it was before
constexpr double patience_px = 30;

std::string percent(double share) {
  return fixed_text(100 * share, 0) + " %";
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
    reasons.push_back(blurred ? "blurred: its edges are " + fixed_text(pose.edge_blur_px, 1) + " px soft, " +
                                    fixed_text(usual, 1) + " px in other poses"
                              : "");
  }
  return reasons;
}

bool has_pairs(const std::vector<PoseObservation>& poses) {
  return std::ranges::any_of(poses, [](const auto& pose) { return !pose.projected.empty(); });
}

bool has_captures(const std::vector<PoseObservation>& poses) {
  return std::ranges::any_of(poses, [](const auto& pose) { return !pose.in_projector.empty(); });
}

std::vector<PoseObservation> half_turned(std::vector<PoseObservation> poses, const ProjectedBoard& board) {
  for (PoseObservation& pose : poses)
    for (Beam& beam : pose.projected) beam.projector_px = board.half_turned(beam.projector_px);
  return poses;
}

// What camera and projector disagree by, a corner: no corner counts for more than a limit.
double disagreement(const CalibrationRequest& request, const std::vector<PoseObservation>& poses,
                    const std::vector<bool>& used, const RigEstimate& rig) {
  double sum = 0;
  double count = 0;
  std::vector<Vector2d> residuals;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!used[i]) continue;
    predict_residuals(rig.calibration, rig.camera_from_board[i], request.board, poses[i], residuals);
    for (std::size_t k = camera_count(poses[i]); k < residuals.size(); ++k, ++count)
      sum += std::min(residuals[k].norm(), patience_px);
  }
  return count > 0 ? sum / count : patience_px;
}

struct Start {
  std::vector<PoseObservation> poses;  // the projected boards the right way round
  RigEstimate rig;
};

Expected<Start> start_whole(const CalibrationRequest& request, std::vector<PoseObservation> poses,
                            const std::vector<bool>& used) {
  const auto guess = [&](const std::vector<PoseObservation>& of) {
    return guess_rig(request.board, of, used, request.camera, request.projector);
  };
  Expected<RigEstimate> rig = guess(poses);
  if (request.projected_board && has_pairs(poses) && has_captures(poses)) {
    std::vector<PoseObservation> turned = half_turned(poses, *request.projected_board);
    Expected<RigEstimate> other = guess(turned);
    if (other &&
        (!rig || disagreement(request, turned, used, *other) < disagreement(request, poses, used, *rig)))
      return Start{std::move(turned), std::move(*other)};
  }
  if (!rig) return tl::unexpected(rig.error());
  return Start{std::move(poses), std::move(*rig)};
}

double turn_between(const RigidTransform& one, const RigidTransform& other) {
  return Eigen::AngleAxisd(one.rotation.transpose() * other.rotation).angle();
}

// Every board where the kept camera sees it, the projector where they tell.
Expected<Start> start_from_kept(const CalibrationRequest& request, std::vector<PoseObservation> poses,
                                const std::vector<bool>& used) {
  Start start{std::move(poses), {request.kept->calibration, std::vector<RigidTransform>(used.size())}};
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    const auto pose = guess_board(request.board, start.poses[i], start.rig.calibration.camera);
    if (!pose) return input_error(start.poses[i].name + ": its corners do not determine a plane");
    start.rig.camera_from_board[i] = *pose;
  }
  const auto place = [&](Start& of) -> Expected<void> {
    const auto extrinsics = guess_extrinsics(request.board, of.poses, used, of.rig);
    if (!extrinsics) return tl::unexpected(extrinsics.error());
    of.rig.calibration.projector_from_camera = *extrinsics;
    return {};
  };
  if (request.projected_board && has_pairs(start.poses)) {
    Start turned{half_turned(start.poses, *request.projected_board), start.rig};
    const Expected<void> placed = place(start).and_then([&] { return place(turned); });
    if (!placed) return tl::unexpected(placed.error());
    const RigidTransform& kept = request.kept->calibration.projector_from_camera;
    const auto misfit = [&](const Start& of) {
      return has_captures(of.poses) ? disagreement(request, of.poses, used, of.rig)
                                    : turn_between(of.rig.calibration.projector_from_camera, kept);
    };
    return misfit(turned) < misfit(start) ? turned : start;
  }
  if (Expected<void> placed = place(start); !placed) return tl::unexpected(placed.error());
  return start;
}

// Relative standard deviation of a focal length that the poses leave.
double focal_uncertainty(const AdjustmentProblem& problem, const Adjustment& fit, int parameter) {
  const int at = position_in(problem.free, parameter);
  const double variance = covariance_of(fit)(at, at);
  const double value = parameter_value(fit.rig.calibration, parameter);
  return variance >= 0 && value > 0 ? std::sqrt(variance) / value : std::numeric_limits<double>::infinity();
}

std::string lines_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += "\n  " + line;
  return text;
}

Expected<void> check_focal_lengths(const AdjustmentProblem& problem, const Adjustment& fit) {
  for (const int parameter :
       {camera_parameter(LensParameter::focal), projector_parameter(LensParameter::focal)}) {
    const double uncertainty = focal_uncertainty(problem, fit, parameter);
    if (uncertainty < max_focal_uncertainty) continue;
    const std::string message =
        "the poses are too much alike to tell the focal lengths (" + parameter_name(parameter) + " to " +
        percent(std::min(uncertainty, 9.99)) +
        "): hold the board tilted by 20 to 40 degrees, to the left, the right, up and down, "
        "nearer and farther";
    return input_error(message + lines_of(advise_on_poses(problem, fit)));
  }
  return check_calibration(fit.rig.calibration);
}

// Poses that contradict one another, so that which one is bad cannot be told.
Expected<void> check_agreement(double surprise, const CalibrationReport& report) {
  if (surprise < disagreeing) return {};
  return input_error(
      "the poses contradict one another: a pose is " + fixed_text(*report.leave_one_out_camera_px, 2) +
      " px off in the camera and " + fixed_text(*report.leave_one_out_projector_px, 2) +
      " px off in the projector when the others are calibrated without it; at least one is bad, or they tell "
      "too little, and a few more good ones would show which");
}

// Those of before, and `more` where there were none.
std::vector<std::string> reasons_with(std::vector<std::string> reasons,
                                      const std::vector<std::string>& more) {
  for (std::size_t i = 0; i < reasons.size(); ++i)
    if (reasons[i].empty()) reasons[i] = more[i];
  return reasons;
}

bool fits_as_before(double rms_px, double before_px, double limit_px) {
  if (before_px > 0) limit_px = std::min(limit_px, kept_ratio * std::max(before_px, least_misfit_px));
  return rms_px <= limit_px;
}

Expected<CalibrationResult> calibrate_extrinsics(const CalibrationRequest& request, const Start& start,
                                                 const std::vector<bool>& used,
                                                 std::vector<std::string> reasons) {
  AdjustmentProblem problem{request.board, start.poses, used, extrinsics_only()};
  Adjustment fit = adjust(problem, start.rig);
  reasons = reasons_with(std::move(reasons), leave_out_disagreeing(problem, fit));
  CalibrationResult result{fit.rig.calibration, report_of(problem, {fit, {}}, reasons)};
  const CalibrationReport& report = result.report;
  const KeptCalibration& kept = *request.kept;
  if (!fits_as_before(report.camera_rms_px, kept.camera_rms_px, max_kept_camera_px) ||
      !fits_as_before(report.projector_rms_px, kept.projector_rms_px, max_kept_projector_px))
    return input_error(
        "the kept lenses do not fit these pictures: " + fixed_text(report.camera_rms_px, 2) +
        " px off in the camera, " + fixed_text(report.projector_rms_px, 2) +
        " px in the projector; focus or zoom was changed, or a picture is bad: calibrate anew, "
        "from several poses" +
        bad_poses(request, reasons));
  const double surprise = report_leave_one_out(problem, fit, result.report);
  if (const Expected<void> agree = check_agreement(surprise, result.report); !agree)
    return input_error(agree.error().message + bad_poses(request, reasons));
  if (std::ranges::count(problem.used, true) == 1)
    result.report.advice.emplace_back(
        "one pose tells where the projector is, but nothing checks it: a second one, held elsewhere, would");
  return result;
}

Expected<CalibrationResult> calibrate_whole(const CalibrationRequest& request, const Start& start,
                                            const std::vector<bool>& used, std::vector<std::string> reasons) {
  AdjustmentProblem problem{request.board, start.poses, used, {}};
  problem.free = all_parameters(static_cast<int>(std::ranges::count(used, true)));
  Adjustment fit = adjust(problem, start.rig);
  reasons = reasons_with(std::move(reasons), leave_out_disagreeing(problem, fit));
  problem.free = all_parameters(static_cast<int>(std::ranges::count(problem.used, true)));
  const SupportedFit supported = adjust_supported(problem, fit.rig);
  if (const Expected<void> known = check_focal_lengths(problem, supported.fit); !known)
    return input_error(known.error().message + bad_poses(request, reasons));
  CalibrationResult result{supported.fit.rig.calibration, report_of(problem, supported, reasons)};
  const double surprise = report_leave_one_out(problem, supported.fit, result.report);
  if (const Expected<void> agree = check_agreement(surprise, result.report); !agree)
    return input_error(agree.error().message + bad_poses(request, reasons) +
                       lines_of(advise_on_poses(problem, supported.fit)));
  result.report.advice = advise(problem, supported);
  if (has_pairs(start.poses) && !has_captures(start.poses))
    result.report.advice.emplace_back(
        "pairs of pictures do not tell whether the projector stands upright or upside down: it is taken to "
        "stand so that its picture's right is the camera picture's right (or below); a Gray-code pose tells");
  return result;
}

}  // namespace

Expected<CalibrationResult> calibrate(const CalibrationRequest& request) {
  std::vector<std::string> reasons;
  std::vector<bool> used;
  const std::vector<std::string> blurred = blurred_poses(request);
  for (std::size_t i = 0; i < request.poses.size(); ++i) {
    reasons.push_back(request.poses[i].failure.empty() ? blurred[i] : request.poses[i].failure);
    used.push_back(reasons.back().empty());
  }
  const std::ptrdiff_t good = std::ranges::count(used, true);
  const int needed = request.kept ? 1 : fewest_poses;
  if (good < needed) return too_few(request, reasons, good, needed);
  const Expected<Start> start = request.kept ? start_from_kept(request, observations_of(request), used)
                                             : start_whole(request, observations_of(request), used);
  if (!start) return input_error(start.error().message + bad_poses(request, reasons));
  return request.kept ? calibrate_extrinsics(request, *start, used, reasons)
                      : calibrate_whole(request, *start, used, reasons);
}

}  // namespace bodyscan
