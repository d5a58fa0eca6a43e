#include "pipeline/calibration/starting_point.hpp"

#include "pipeline/calibration/initial_guess.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

namespace bodyscan {
namespace {

using Eigen::Vector2d;

constexpr double patience_px = 30;  // no corner counts for more

template <class Corners>
bool any_used(const std::vector<PoseObservation>& poses, const std::vector<bool>& used,
              Corners PoseObservation::*corners) {
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (used[i] && !(poses[i].*corners).empty()) return true;
  return false;
}

std::vector<PoseObservation> observations_of(const CalibrationRequest& request) {
  std::vector<PoseObservation> poses;
  for (const CalibrationPose& pose : request.poses) poses.push_back(pose.observation);
  return poses;
}

// The poses with their projected boards counted from each corner they may be counted from.
std::vector<std::vector<PoseObservation>> ways_round(const CalibrationRequest& request,
                                                     const std::vector<bool>& used) {
  std::vector<std::vector<PoseObservation>> ways{observations_of(request)};
  if (!request.projected_board || !has_pairs(ways[0], used)) return ways;
  const ProjectedBoard& board = *request.projected_board;
  const auto turned = [](std::vector<PoseObservation> poses, const auto& turn) {
    for (PoseObservation& pose : poses)
      for (Beam& beam : pose.projected) beam.projector_px = turn(beam.projector_px);
    return poses;
  };
  const auto half = [&](const Vector2d& px) { return board.half_turned(px); };
  const auto quarter = [&](const Vector2d& px) { return board.quarter_turned(px); };
  ways.push_back(turned(ways[0], half));
  if (board.square()) {
    ways.push_back(turned(ways[0], quarter));
    ways.push_back(turned(ways[1], quarter));
  }
  return ways;
}

// Mean of what camera and projector disagree by, a corner.
double disagreement(const CalibrationRequest& request, const StartingPoint& start,
                    const std::vector<bool>& used) {
  double sum = 0;
  double count = 0;
  std::vector<Vector2d> residuals;
  for (std::size_t i = 0; i < start.poses.size(); ++i) {
    if (!used[i]) continue;
    predict_residuals(start.rig.calibration, start.rig.camera_from_board[i], request.board, start.poses[i],
                      residuals);
    for (std::size_t k = camera_count(start.poses[i]); k < residuals.size(); ++k, ++count)
      sum += std::min(residuals[k].norm(), patience_px);
  }
  return count > 0 ? sum / count : patience_px;
}

double turn_between(const RigidTransform& one, const RigidTransform& other) {
  return Eigen::AngleAxisd(one.rotation.transpose() * other.rotation).angle();
}

// The start from each way round that misfits least; the first way's error where none gives a start.
template <class From, class Misfit>
Expected<StartingPoint> best_start(std::vector<std::vector<PoseObservation>> ways, const From& from,
                                   const Misfit& misfit) {
  Expected<StartingPoint> best = from(std::move(ways[0]));
  for (std::size_t i = 1; i < ways.size(); ++i) {
    Expected<StartingPoint> other = from(std::move(ways[i]));
    if (other && (!best || misfit(*other) < misfit(*best))) best = std::move(other);
  }
  return best;
}

}  // namespace

bool has_pairs(const std::vector<PoseObservation>& poses, const std::vector<bool>& used) {
  return any_used(poses, used, &PoseObservation::projected);
}

bool has_captures(const std::vector<PoseObservation>& poses, const std::vector<bool>& used) {
  return any_used(poses, used, &PoseObservation::in_projector);
}

Expected<StartingPoint> start_whole(const CalibrationRequest& request, const std::vector<bool>& used) {
  std::vector<std::vector<PoseObservation>> ways = ways_round(request, used);
  if (!has_captures(ways[0], used)) ways.resize(1);
  const auto from = [&](std::vector<PoseObservation> poses) -> Expected<StartingPoint> {
    Expected<RigEstimate> rig = guess_rig(request.board, poses, used, request.camera, request.projector);
    if (!rig) return tl::unexpected(rig.error());
    return StartingPoint{std::move(poses), std::move(*rig)};
  };
  return best_start(std::move(ways), from,
                    [&](const StartingPoint& start) { return disagreement(request, start, used); });
}

Expected<StartingPoint> start_from_kept(const CalibrationRequest& request, const std::vector<bool>& used) {
  const Calibration& kept = request.kept->calibration;
  const auto from = [&](std::vector<PoseObservation> poses) -> Expected<StartingPoint> {
    StartingPoint start{std::move(poses), {kept, std::vector<RigidTransform>(used.size())}};
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (!used[i]) continue;
      const auto pose = guess_board(request.board, start.poses[i], kept.camera);
      if (!pose) return input_error(start.poses[i].name + ": its corners do not determine a plane");
      start.rig.camera_from_board[i] = *pose;
    }
    const auto extrinsics = guess_extrinsics(request.board, start.poses, used, start.rig);
    if (!extrinsics) return tl::unexpected(extrinsics.error());
    start.rig.calibration.projector_from_camera = *extrinsics;
    return start;
  };
  const auto misfit = [&](const StartingPoint& start) {
    return has_captures(start.poses, used)
               ? disagreement(request, start, used)
               : turn_between(start.rig.calibration.projector_from_camera, kept.projector_from_camera);
  };
  return best_start(ways_round(request, used), from, misfit);
}

}  // namespace bodyscan
