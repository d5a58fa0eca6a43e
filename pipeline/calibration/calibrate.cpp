#include "pipeline/calibration/calibrate.hpp"

#include "pipeline/base/median.hpp"
#include "pipeline/base/number_text.hpp"
#include "pipeline/calibration/advice.hpp"
#include "pipeline/calibration/fit_check.hpp"
#include "pipeline/calibration/fit_report.hpp"
#include "pipeline/calibration/parameter_selection.hpp"
#include "pipeline/calibration/pose_agreement.hpp"
#include "pipeline/calibration/starting_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

namespace bodyscan {
namespace {

constexpr double blur_ratio = 2.5;  // times the poses' median: a blurred picture
constexpr double min_blur_px = 2;
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

// Those of before, and `more` where there were none.
std::vector<std::string> reasons_with(std::vector<std::string> reasons,
                                      const std::vector<std::string>& more) {
  for (std::size_t i = 0; i < reasons.size(); ++i)
    if (reasons[i].empty()) reasons[i] = more[i];
  return reasons;
}

Expected<CalibrationResult> calibrate_extrinsics(const CalibrationRequest& request,
                                                 const StartingPoint& start, const std::vector<bool>& used,
                                                 std::vector<std::string> reasons) {
  AdjustmentProblem problem{request.board, start.poses, used, extrinsics_only()};
  Adjustment fit = adjust(problem, start.rig);
  reasons = reasons_with(std::move(reasons), leave_out_disagreeing(problem, fit, fewest_kept_poses));
  CalibrationResult result{fit.rig.calibration, report_of(problem, {fit, {}}, reasons)};
  if (const Expected<void> kept = check_kept(problem, result.report, *request.kept); !kept)
    return input_error(kept.error().message + bad_poses(request, reasons));
  const double surprise = report_leave_one_out(problem, fit, result.report);
  if (const Expected<void> agree = check_agreement(problem, fit, surprise, result.report); !agree)
    return input_error(agree.error().message + bad_poses(request, reasons));
  if (const auto far =
          far_move(result.calibration.projector_from_camera, request.kept->calibration.projector_from_camera))
    result.report.advice.push_back(*far);
  if (std::ranges::count(problem.used, true) == 1)
    result.report.advice.emplace_back(
        "one pose tells where the projector is, but nothing checks it: a second one, held elsewhere, would");
  return result;
}

Expected<CalibrationResult> calibrate_whole(const CalibrationRequest& request, const StartingPoint& start,
                                            const std::vector<bool>& used, std::vector<std::string> reasons) {
  AdjustmentProblem problem{request.board, start.poses, used, {}};
  problem.free = all_parameters(static_cast<int>(std::ranges::count(used, true)));
  Adjustment fit = adjust(problem, start.rig);
  reasons = reasons_with(std::move(reasons), leave_out_disagreeing(problem, fit, fewest_poses));
  if (const int different = different_poses(problem, fit.rig.camera_from_board); different < fewest_poses) {
    const auto repeated = name_repeated(problem, fit.rig.camera_from_board);
    return too_few(request, reasons_with(reasons, repeated), different, fewest_poses);
  }
  problem.free = all_parameters(static_cast<int>(std::ranges::count(problem.used, true)));
  const SupportedFit supported = adjust_supported(problem, fit.rig);
  if (const Expected<void> known = check_focal_lengths(problem, supported.fit); !known)
    return input_error(known.error().message + bad_poses(request, reasons));
  CalibrationResult result{supported.fit.rig.calibration, report_of(problem, supported, reasons)};
  if (const Expected<void> sound = check_fit(problem, result.report); !sound)
    return input_error(sound.error().message + bad_poses(request, reasons));
  const double surprise = report_leave_one_out(problem, supported.fit, result.report);
  if (const Expected<void> agree = check_agreement(problem, supported.fit, surprise, result.report); !agree)
    return input_error(agree.error().message + bad_poses(request, reasons));
  result.report.advice = advise(problem, supported);
  if (has_pairs(start.poses, problem.used) && !has_captures(start.poses, problem.used))
    result.report.advice.emplace_back(
        "pairs of pictures do not tell whether the projector stands upright or upside down, nor whether the "
        "pictures are mirrored: it is taken to stand so that its picture's right is the camera picture's "
        "right (or below); a Gray-code pose tells");
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
  const Expected<StartingPoint> start =
      request.kept ? start_from_kept(request, used) : start_whole(request, used);
  if (!start) return input_error(start.error().message + bad_poses(request, reasons));
  return request.kept ? calibrate_extrinsics(request, *start, used, reasons)
                      : calibrate_whole(request, *start, used, reasons);
}

}  // namespace bodyscan
