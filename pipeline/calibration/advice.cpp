#include "pipeline/calibration/advice.hpp"

#include "pipeline/base/number_text.hpp"
#include "pipeline/calibration/rig_uncertainty.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace bodyscan {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double degree = std::numbers::pi / 180;
constexpr double few_tilts_degrees = 15;  // largest angle between two boards
constexpr double one_distance = 0.1;      // largest over smallest, less one
constexpr double nearly_parallel_degrees = 8;
constexpr double same_place = 0.15;  // see distance_between
constexpr double unmoved_degrees = 1;
constexpr double unmoved_place = 0.02;
constexpr double little_coverage = 0.5;  // of the picture's width or height
constexpr double poor_focal = 0.003;     // relative
constexpr double worth_while = 0.7;      // of the uncertainty left by one more pose
constexpr double tilt = 30;              // degrees, of suggested poses

// Of two boards' normals, degrees.
double angle_between(const RigidTransform& one, const RigidTransform& other) {
  return std::acos(std::clamp(one.rotation.col(2).dot(other.rotation.col(2)), -1.0, 1.0)) / degree;
}

// Root mean square of how far the board's outermost corners lie apart, as a share of its diagonal.
double distance_between(const PrintedBoard& board, const RigidTransform& one, const RigidTransform& other) {
  const Vector3d middle = board.middle_mm();
  double squares = 0;
  for (const auto& [x, y] : {std::pair(0, 0), std::pair(2, 0), std::pair(0, 2), std::pair(2, 2)}) {
    const Vector3d corner(x * middle.x(), y * middle.y(), 0);
    squares += (one * corner - other * corner).squaredNorm() / 4;
  }
  return std::sqrt(squares) / (2 * middle.norm());
}

// Largest angle between the used boards' normals, degrees, and distances, mm.
struct Spread {
  double angle = 0;
  double nearest = std::numeric_limits<double>::max();
  double farthest = 0;
};

Spread spread_of(const AdjustmentProblem& problem, const Adjustment& fit) {
  Spread spread;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    if (!problem.used[i]) continue;
    const RigidTransform& one = fit.rig.camera_from_board[i];
    const double distance = (one * problem.board.middle_mm()).norm();
    spread.nearest = std::min(spread.nearest, distance);
    spread.farthest = std::max(spread.farthest, distance);
    for (std::size_t k = 0; k < i; ++k) {
      if (!problem.used[k]) continue;
      spread.angle = std::max(spread.angle, angle_between(one, fit.rig.camera_from_board[k]));
    }
  }
  return spread;
}

// Share of the camera's width and height between the outermost corners.
Vector2d coverage_of(const AdjustmentProblem& problem, Size camera) {
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::max());
  Vector2d high = -low;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    if (!problem.used[i]) continue;
    for (const SeenCorner& seen : problem.poses[i].in_camera) {
      low = low.cwiseMin(seen.px);
      high = high.cwiseMax(seen.px);
    }
  }
  return (high - low).cwiseQuotient(Vector2d(camera.width, camera.height));
}

struct Suggestion {
  std::string words;
  RigidTransform camera_from_board;
};

std::vector<Suggestion> suggestions(const AdjustmentProblem& problem, const Adjustment& fit,
                                    const Spread& spread) {
  struct Named {
    const char* words;
    Vector2d value;
  };
  const std::array<Named, 5> tilts{Named{"facing the camera", {0, 0}},
                                   Named{"its upper edge tilted away by 30 degrees", {-tilt, 0}},
                                   Named{"its lower edge tilted away by 30 degrees", {tilt, 0}},
                                   Named{"its left edge tilted away by 30 degrees", {0, tilt}},
                                   Named{"its right edge tilted away by 30 degrees", {0, -tilt}}};
  const std::array<Named, 5> places{Named{"in the middle", {0, 0}}, Named{"at the left", {-0.2, 0}},
                                    Named{"at the right", {0.2, 0}}, Named{"at the top", {0, -0.15}},
                                    Named{"at the bottom", {0, 0.15}}};
  const Lens& camera = fit.rig.calibration.camera;
  const double usual = (spread.nearest + spread.farthest) / 2;
  std::vector<Suggestion> result;
  for (const Named& leaning : tilts) {
    for (const Named& place : places) {
      for (const double distance : {0.85 * usual, usual, 1.15 * usual}) {
        const Vector2d px(camera.size.width * (0.5 + place.value.x()),
                          camera.size.height * (0.5 + place.value.y()));
        RigidTransform pose;
        pose.rotation = rotation_of(degree * Vector3d(leaning.value.x(), leaning.value.y(), 0));
        pose.translation = camera.ray(px) * distance - pose.rotation * problem.board.middle_mm();
        result.push_back({std::string("the board ") + place.words + ", " + leaning.words + ", " +
                              fixed_text(distance / 1000, 2) + " m away",
                          pose});
      }
    }
  }
  return result;
}

bool in_picture(const Lens& lens, const Vector2d& px) {
  return px.x() >= 0 && px.y() >= 0 && px.x() < lens.size.width && px.y() < lens.size.height;
}

// What both devices would see of the board there; nothing where a corner is out of sight.
std::optional<PoseObservation> view_of(const Calibration& calibration, const PrintedBoard& board,
                                       const RigidTransform& camera_from_board) {
  PoseObservation pose;
  for (int i = 0; i < board.corner_count(); ++i) {
    const Vector2d corner = board.corner_mm(i);
    const Vector3d point = camera_from_board * Vector3d(corner.x(), corner.y(), 0);
    const Vector3d from_projector = calibration.projector_from_camera * point;
    if (!(point.z() > 0) || !(from_projector.z() > 0)) return std::nullopt;
    pose.in_camera.push_back({i, calibration.camera.project(point)});
    pose.in_projector.push_back({i, calibration.projector.project(from_projector)});
    if (!in_picture(calibration.camera, pose.in_camera.back().px) ||
        !in_picture(calibration.projector, pose.in_projector.back().px))
      return std::nullopt;
  }
  return pose;
}

// Lens parameters that were never free.
std::string not_tried(const AdjustmentProblem& problem, const SupportedFit& supported) {
  std::string names;
  for (int p = 0; p < 2 * lens_parameters; ++p) {
    const bool fixed = std::ranges::count(supported.fixed, p, &FixedParameter::parameter) > 0;
    if (!problem.free[static_cast<std::size_t>(p)] && !fixed)
      names += (names.empty() ? "" : ", ") + parameter_name(p);
  }
  return names;
}

// "camera k3 (+- 0.2)"
std::string with_sigma(const FixedParameter& fixed) {
  const bool pixels = std::ranges::any_of(std::array{LensParameter::cx, LensParameter::cy}, [&](auto which) {
    return fixed.parameter % lens_parameters == static_cast<int>(which);
  });
  return parameter_name(fixed.parameter) + " (+- " +
         (pixels ? significant_text(fixed.sigma, 2) + " px)" : significant_text(fixed.sigma, 1) + ")");
}

}  // namespace

std::vector<std::string> advise_on_poses(const AdjustmentProblem& problem, const Adjustment& fit) {
  std::vector<std::string> lines;
  const Spread spread = spread_of(problem, fit);
  if (spread.angle < few_tilts_degrees)
    lines.push_back("the boards are nearly parallel, within " + fixed_text(spread.angle, 1) +
                    " degrees: focal lengths, principal points and distances cannot be told apart well; tilt "
                    "the board by 20 to 40 degrees both ways");
  if (spread.farthest < (1 + one_distance) * spread.nearest)
    lines.emplace_back("all boards are about equally far away: hold some nearer, some farther");
  const Vector2d coverage = coverage_of(problem, fit.rig.calibration.camera.size);
  if (coverage.minCoeff() < little_coverage)
    lines.push_back(
        "the corners cover " + fixed_text(100 * coverage.x(), 0) + " % of the picture's width and " +
        fixed_text(100 * coverage.y(), 0) +
        " % of its height: beyond, the lens distortion is a guess; hold the board towards the borders too");
  return lines;
}

std::vector<std::string> advise(const AdjustmentProblem& problem, const SupportedFit& supported) {
  const Adjustment& fit = supported.fit;
  std::vector<std::string> lines = advise_on_poses(problem, fit);
  std::string names;
  for (const FixedParameter& fixed : supported.fixed)
    names += (names.empty() ? "" : ", ") + with_sigma(fixed);
  if (const std::string untried = not_tried(problem, supported); !untried.empty())
    lines.push_back("not estimated from fewer than five poses: " + untried);
  if (!names.empty())
    lines.push_back("left at their usual values, from which these poses cannot tell them: " + names);
  const Spread spread = spread_of(problem, fit);
  const double before = relative_uncertainty(problem.free, fit.rig.calibration, fit.information);
  double best = before;
  std::string words;
  for (const Suggestion& suggestion : suggestions(problem, fit, spread)) {
    const auto view = view_of(fit.rig.calibration, problem.board, suggestion.camera_from_board);
    if (!view) continue;
    const double after = relative_uncertainty(
        problem.free, fit.rig.calibration,
        fit.information + information_of_pose(problem, fit.rig.calibration, suggestion.camera_from_board,
                                              *view, fit.sigmas));
    if (after >= best) continue;
    best = after;
    words = suggestion.words;
  }
  if (!words.empty() && (before > poor_focal || best < worth_while * before))
    lines.push_back("one more pose would help most with " + words +
                    ": focal lengths and baseline, known to " + significant_text(100 * before, 2) +
                    " % together, would be known to " + significant_text(100 * best, 2) + " %");
  return lines;
}

int different_poses(const AdjustmentProblem& problem, const std::vector<RigidTransform>& camera_from_board) {
  int count = 0;
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    if (!problem.used[i]) continue;
    bool repeats = false;
    for (std::size_t k = 0; k < i && !repeats; ++k)
      repeats = problem.used[k] &&
                angle_between(camera_from_board[i], camera_from_board[k]) < unmoved_degrees &&
                distance_between(problem.board, camera_from_board[i], camera_from_board[k]) < unmoved_place;
    count += repeats ? 0 : 1;
  }
  return count;
}

std::vector<std::string> name_repeated(const AdjustmentProblem& problem,
                                       const std::vector<RigidTransform>& camera_from_board) {
  std::vector<std::string> notes(problem.poses.size());
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    for (std::size_t k = 0; k < i && problem.used[i] && notes[i].empty(); ++k) {
      if (!problem.used[k] || !notes[k].empty()) continue;
      const double angle = angle_between(camera_from_board[i], camera_from_board[k]);
      if (angle > nearly_parallel_degrees ||
          distance_between(problem.board, camera_from_board[i], camera_from_board[k]) > same_place)
        continue;
      notes[i] = "nearly parallel to " + problem.poses[k].name + " (" + fixed_text(angle, 1) +
                 " degrees) and at the same place: adds nothing new";
    }
  }
  return notes;
}

}  // namespace bodyscan
