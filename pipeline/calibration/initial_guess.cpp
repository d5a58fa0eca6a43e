#include "pipeline/calibration/initial_guess.hpp"

#include "pipeline/board/homography.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace bodyscan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double smallest_focal = 0.4;  // of the picture's width
constexpr double largest_focal = 10;
constexpr int focal_steps = 24;
constexpr std::size_t most_judged = 20;
constexpr double patience_px = 30;  // no residual counts for more, so that a bad pose does not decide

double focal_of(int step, Size size) {
  return size.width * smallest_focal *
         std::pow(largest_focal / smallest_focal, static_cast<double>(step) / (focal_steps - 1));
}

Lens plain_lens(Size size, double focal, double cy) {
  Lens lens;
  lens.size = size;
  lens.fx = focal;
  lens.fy = focal;
  lens.cx = (size.width - 1) / 2.0;
  lens.cy = cy;
  return lens;
}

struct Pairs {
  std::vector<Vector2d> plane;  // mm, board frame
  std::vector<Vector2d> px;
  std::optional<Eigen::Matrix3d> px_from_plane;  // as if there were no distortion

  void fit() { px_from_plane = fit_homography(plane, px); }
};

Pairs camera_pairs(const PrintedBoard& board, const PoseObservation& pose) {
  Pairs pairs;
  for (const SeenCorner& seen : pose.in_camera) {
    pairs.plane.push_back(board.corner_mm(seen.corner));
    pairs.px.push_back(seen.px);
  }
  pairs.fit();
  return pairs;
}

Pairs projector_pairs(const PrintedBoard& board, const PoseObservation& pose, const Lens& camera,
                      const RigidTransform& camera_from_board) {
  Pairs pairs;
  for (const SeenCorner& seen : pose.in_projector) {
    pairs.plane.push_back(board.corner_mm(seen.corner));
    pairs.px.push_back(seen.px);
  }
  for (const Beam& beam : pose.projected) {
    const Vector3d point = on_board_plane(camera_from_board, camera.ray(beam.camera_px));
    pairs.plane.emplace_back(
        (camera_from_board.rotation.transpose() * (point - camera_from_board.translation)).head<2>());
    pairs.px.push_back(beam.projector_px);
  }
  pairs.fit();
  return pairs;
}

// For a lens without distortion.
std::optional<RigidTransform> pose_in(const Lens& lens, const Pairs& pairs) {
  if (!pairs.px_from_plane) return std::nullopt;
  Eigen::Matrix3d ideal_from_px;
  ideal_from_px << 1 / lens.fx, 0, -lens.cx / lens.fx, 0, 1 / lens.fy, -lens.cy / lens.fy, 0, 0, 1;
  return pose_of_plane(ideal_from_px * *pairs.px_from_plane);
}

// The pixels where a lens without distortion would see what this one sees there.
Pairs undistorted(Pairs pairs, const Lens& lens) {
  for (Vector2d& px : pairs.px) {
    const Vector3d ray = lens.ray(px);
    px = Vector2d(lens.fx * ray.x() + lens.cx, lens.fy * ray.y() + lens.cy);
  }
  pairs.fit();
  return pairs;
}

double misfit(const Lens& lens, const RigidTransform& lens_from_board, const Pairs& pairs) {
  double sum = 0;
  for (std::size_t i = 0; i < pairs.px.size(); ++i) {
    const Vector3d point = lens_from_board * Vector3d(pairs.plane[i].x(), pairs.plane[i].y(), 0);
    const double distance = point.z() > 0 ? (lens.project(point) - pairs.px[i]).norm() : patience_px;
    sum += std::min(distance, patience_px);
  }
  return sum;
}

Lens guess_camera(const std::vector<Pairs>& poses, Size size) {
  Lens best;
  double least = std::numeric_limits<double>::max();
  for (int step = 0; step < focal_steps; ++step) {
    const Lens lens = plain_lens(size, focal_of(step, size), (size.height - 1) / 2.0);
    double sum = 0;
    for (const Pairs& pairs : poses) {
      const auto pose = pose_in(lens, pairs);
      sum += pose ? misfit(lens, *pose, pairs) : patience_px * static_cast<double>(pairs.px.size());
    }
    if (sum >= least) continue;
    least = sum;
    best = lens;
  }
  return best;
}

struct ProjectorGuess {
  Lens lens;
  RigidTransform projector_from_camera;
  double misfit = std::numeric_limits<double>::max();
};

// The best of the poses each single board gives, judged by all boards, or by some of very many.
ProjectorGuess best_pose(const Lens& lens, const std::vector<Pairs>& pairs,
                         const std::vector<RigidTransform>& camera_from_board) {
  ProjectorGuess best{lens, {}};
  const std::size_t stride = pairs.size() / most_judged + 1;
  for (std::size_t i = 0; i < pairs.size(); i += stride) {
    const auto pose = pose_in(lens, pairs[i]);
    if (!pose) continue;
    const RigidTransform candidate = *pose * camera_from_board[i].inverse();
    double sum = 0;
    for (std::size_t k = 0; k < pairs.size(); k += stride)
      sum += misfit(lens, candidate * camera_from_board[k], pairs[k]);
    if (sum < best.misfit) best = {lens, candidate, sum};
  }
  return best;
}

// Of the used poses.
struct ProjectorData {
  std::vector<Pairs> pairs;
  std::vector<RigidTransform> camera_from_board;
};

ProjectorData projector_data(const PrintedBoard& board, const std::vector<PoseObservation>& poses,
                             const std::vector<bool>& used, const RigEstimate& rig) {
  ProjectorData data;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!used[i]) continue;
    data.pairs.push_back(projector_pairs(board, poses[i], rig.calibration.camera, rig.camera_from_board[i]));
    data.camera_from_board.push_back(rig.camera_from_board[i]);
  }
  return data;
}

void set_free(ParameterMask& mask, std::initializer_list<int> parameters) {
  for (const int parameter : parameters) mask.set(static_cast<std::size_t>(parameter));
}

}  // namespace

std::optional<RigidTransform> guess_board(const PrintedBoard& board, const PoseObservation& pose,
                                          const Lens& camera) {
  return pose_in(camera, undistorted(camera_pairs(board, pose), camera));
}

Expected<RigidTransform> guess_extrinsics(const PrintedBoard& board,
                                          const std::vector<PoseObservation>& poses,
                                          const std::vector<bool>& used, const RigEstimate& rig) {
  ProjectorData data = projector_data(board, poses, used, rig);
  Lens plain = rig.calibration.projector;
  plain.distortion = {};
  for (Pairs& pairs : data.pairs) pairs = undistorted(std::move(pairs), rig.calibration.projector);
  const ProjectorGuess best = best_pose(plain, data.pairs, data.camera_from_board);
  if (best.misfit == std::numeric_limits<double>::max())
    return input_error("no pose determines where the projector is");
  return best.projector_from_camera;
}

Expected<RigEstimate> guess_rig(const PrintedBoard& board, const std::vector<PoseObservation>& poses,
                                const std::vector<bool>& used, Size camera, Size projector) {
  std::vector<Pairs> seen;
  std::vector<PoseObservation> camera_only = poses;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (used[i]) seen.push_back(camera_pairs(board, poses[i]));
    camera_only[i].in_projector.clear();
    camera_only[i].projected.clear();
  }
  RigEstimate rig;
  rig.calibration.camera = guess_camera(seen, camera);
  rig.camera_from_board.resize(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!used[i]) continue;
    const auto pose = guess_board(board, poses[i], rig.calibration.camera);
    if (!pose) return input_error(poses[i].name + ": its corners do not determine a plane");
    rig.camera_from_board[i] = *pose;
  }
  rig.calibration.projector = plain_lens(projector, projector.width, (projector.height - 1) / 2.0);
  AdjustmentProblem problem{board, camera_only, used, {}};
  set_free(problem.free, {camera_parameter(LensParameter::focal), camera_parameter(LensParameter::k1)});
  rig = adjust(problem, rig).rig;

  const ProjectorData data = projector_data(board, poses, used, rig);
  ProjectorGuess best;
  for (int step = 0; step < focal_steps; ++step) {
    for (double shift = -0.25; shift <= 1.26; shift += 0.125) {
      const Lens lens = plain_lens(projector, focal_of(step, projector), shift * (projector.height - 1));
      const ProjectorGuess guess = best_pose(lens, data.pairs, data.camera_from_board);
      if (guess.misfit < best.misfit) best = guess;
    }
  }
  if (best.misfit == std::numeric_limits<double>::max())
    return input_error("no pose determines where the projector is");
  rig.calibration.projector = best.lens;
  rig.calibration.projector_from_camera = best.projector_from_camera;
  AdjustmentProblem inverse_camera{board, poses, used, {}, true};
  set_free(inverse_camera.free,
           {projector_parameter(LensParameter::focal), projector_parameter(LensParameter::cy)});
  for (int i = 0; i < 6; ++i) set_free(inverse_camera.free, {extrinsic_parameter(i)});
  return adjust(inverse_camera, rig).rig;
}

}  // namespace bodyscan
