#include "pipeline/calibration/fit_check.hpp"

#include "pipeline/base/number_text.hpp"
#include "pipeline/calibration/advice.hpp"
#include "pipeline/calibration/calibration_file.hpp"
#include "pipeline/calibration/pose_agreement.hpp"
#include "pipeline/calibration/starting_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

namespace bodyscan {
namespace {

constexpr double max_focal_uncertainty = 0.1;  // relative: beyond, the poses tell nothing
constexpr double max_camera_px = 1.5;  // root mean squares that one camera and one projector may leave
constexpr double max_projector_px = 1;
constexpr double max_square_error_percent = 1;
constexpr double max_square_spread_percent = 2;
constexpr double max_kept_camera_px = 1;  // of lenses that still hold, if it is not known how they did before
constexpr double max_kept_projector_px = 0.5;
constexpr double kept_ratio = 4;              // times what it was before
constexpr double least_kept_camera_px = 0.1;  // less is another picture's luck
constexpr double far_from_kept = 0.5;         // of the baseline, or rad

std::string percent(double share) {
  return fixed_text(100 * share, 0) + " %";
}

// Relative standard deviation of a focal length that the poses leave.
double focal_uncertainty(const AdjustmentProblem& problem, const Adjustment& fit, int parameter) {
  const int at = position_in(problem.free, parameter);
  const double variance = covariance_of(fit.information)(at, at);
  const double value = parameter_value(fit.rig.calibration, parameter);
  return variance >= 0 && value > 0 ? std::sqrt(variance) / value : std::numeric_limits<double>::infinity();
}

bool lenses_are_free(const AdjustmentProblem& problem) {
  return problem.free[static_cast<std::size_t>(camera_parameter(LensParameter::focal))];
}

std::string lines_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += "\n  " + line;
  return text;
}

// Root mean square of the projector's misfits over the used poses of one kind.
double misfit_of_kind(const AdjustmentProblem& problem, const CalibrationReport& report, bool pairs) {
  double squares = 0;
  int count = 0;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    if (!problem.used[i] || is_pair(problem.poses[i]) != pairs) continue;
    squares += report.poses[i].projector_rms_px * report.poses[i].projector_rms_px;
    ++count;
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

// Whether the kept lenses still hold. How well pairs of pictures fit says little about captures, so only
// captures are held to what the projector left before.
bool fits_as_before(const CalibrationReport& report, const KeptCalibration& kept, bool pairs) {
  const auto limit = [](double before_px, double least_px, double most_px) {
    return before_px > 0 ? std::min(most_px, kept_ratio * std::max(before_px, least_px)) : most_px;
  };
  return report.camera_rms_px <= limit(kept.camera_rms_px, least_kept_camera_px, max_kept_camera_px) &&
         report.projector_rms_px <=
             (pairs ? max_kept_projector_px
                    : limit(kept.projector_rms_px, least_misfit_px, max_kept_projector_px));
}

}  // namespace

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

Expected<void> check_fit(const AdjustmentProblem& problem, const CalibrationReport& report) {
  if (report.camera_rms_px <= max_camera_px && report.projector_rms_px <= max_projector_px &&
      std::abs(report.square_error_percent.value_or(0)) <= max_square_error_percent &&
      report.square_spread_percent.value_or(0) <= max_square_spread_percent)
    return {};
  std::string message = "no camera and projector fit these poses: " + fixed_text(report.camera_rms_px, 2) +
                        " px off in the camera, " + fixed_text(report.projector_rms_px, 2) +
                        " px in the projector";
  if (report.square_error_percent && report.square_spread_percent)
    message += ", the board's squares come out " + fixed_text(*report.square_error_percent, 2) +
               " % off their printed side, spread " + fixed_text(*report.square_spread_percent, 2) + " %";
  const double pairs = misfit_of_kind(problem, report, true);
  const double captures = misfit_of_kind(problem, report, false);
  if (pairs > kept_ratio * std::max(captures, least_misfit_px) && captures > 0)
    message += "; pairs of pictures are " + fixed_text(pairs, 2) + " px off, captures " +
               fixed_text(captures, 2) + " px: projected_board is not what was shown";
  return input_error(message +
                     "; look at the board's and the projected board's figures in session.json, and "
                     "whether the pictures belong together");
}

Expected<void> check_agreement(const AdjustmentProblem& problem, const Adjustment& fit, double surprise,
                               const CalibrationReport& report) {
  if (surprise < disagreeing) return {};
  return input_error(
      "the poses contradict one another: a pose is " + fixed_text(*report.leave_one_out_camera_px, 2) +
      " px off in the camera and " + fixed_text(*report.leave_one_out_projector_px, 2) +
      " px off in the projector when the others are calibrated without it; at least one is bad, or they tell "
      "too little, and a few more good ones would show which" +
      (lenses_are_free(problem) ? lines_of(advise_on_poses(problem, fit)) : ""));
}

std::optional<std::string> far_move(const RigidTransform& now, const RigidTransform& before) {
  const auto position = [](const RigidTransform& pose) -> Eigen::Vector3d {
    return -(pose.rotation.transpose() * pose.translation);
  };
  const double moved_mm = (position(now) - position(before)).norm();
  const double turned = Eigen::AngleAxisd(before.rotation.transpose() * now.rotation).angle();
  if (moved_mm < far_from_kept * before.translation.norm() && turned < far_from_kept) return std::nullopt;
  return "the projector stands " + fixed_text(moved_mm, 0) + " mm and " +
         fixed_text(turned * 180 / std::numbers::pi, 0) +
         " degrees from where it stood before: if it was not moved that far, the pictures are mirrored or "
         "the "
         "projected board is another one";
}

Expected<void> check_kept(const AdjustmentProblem& problem, const CalibrationReport& report,
                          const KeptCalibration& kept) {
  if (fits_as_before(report, kept, has_pairs(problem.poses, problem.used))) return {};
  return input_error("the kept lenses do not fit these pictures: " + fixed_text(report.camera_rms_px, 2) +
                     " px off in the camera, " + fixed_text(report.projector_rms_px, 2) +
                     " px in the projector; focus or zoom was changed, or a picture is bad: calibrate anew, "
                     "from several poses");
}

}  // namespace bodyscan
