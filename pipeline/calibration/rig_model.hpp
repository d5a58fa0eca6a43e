#pragma once

#include "pipeline/board/board.hpp"
#include "pipeline/board/observations.hpp"
#include "pipeline/geometry/calibration.hpp"

#include <array>
#include <bitset>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace bodyscan {

// What a calibration estimates: both devices, and where each pose's board was.
struct RigEstimate {
  Calibration calibration;
  std::vector<RigidTransform> camera_from_board;  // a pose each, mm
};

// The parameters that all poses share, in this order: nine of the camera, nine of the projector, rotation
// vector (rad) and translation (mm) of projector_from_camera.
enum class LensParameter { focal, aspect, cx, cy, k1, k2, p1, p2, k3 };
constexpr int lens_parameters = 9;
constexpr int shared_parameters = 2 * lens_parameters + 6;
constexpr int pose_parameters = 6;
constexpr int camera_parameter(LensParameter parameter) {
  return static_cast<int>(parameter);
}
constexpr int projector_parameter(LensParameter parameter) {
  return lens_parameters + static_cast<int>(parameter);
}
constexpr int extrinsic_parameter(int index) {
  return 2 * lens_parameters + index;
}

using ParameterMask = std::bitset<shared_parameters>;

// Position of a parameter among those that are in the mask.
int position_in(const ParameterMask& mask, int parameter);

std::string parameter_name(int parameter);
double parameter_value(const Calibration& calibration, int parameter);  // rotations: 0, they are increments

// The calibration with one shared parameter moved by `change`.
Calibration moved(Calibration calibration, int parameter, double change);
// The transform with parameter 0 to 2 (rotation vector, applied after it) or 3 to 5 (translation) moved.
RigidTransform moved(RigidTransform transform, int parameter, double change);

// Change by which a derivative is taken, and which is small for the parameter.
double parameter_step(int parameter, const Calibration& calibration);
double pose_step(int parameter);

// Measured minus predicted, px: first the camera's corners, then the projector's (its printed corners, then
// beams: the camera's ray to a projected corner meets the board's plane, and that point is seen from the
// projector). A point behind a device gives a residual of 1e4 px.
void predict_residuals(const Calibration& calibration, const RigidTransform& camera_from_board,
                       const PrintedBoard& board, const PoseObservation& pose,
                       std::span<const Eigen::Vector3d> beam_rays, std::vector<Eigen::Vector2d>& residuals);

// The same; `beam_rays` are computed.
void predict_residuals(const Calibration& calibration, const RigidTransform& camera_from_board,
                       const PrintedBoard& board, const PoseObservation& pose,
                       std::vector<Eigen::Vector2d>& residuals);

// Camera rays to the projected corners: they depend on the camera alone, and cost most.
std::vector<Eigen::Vector3d> beam_rays(const Lens& camera, const PoseObservation& pose);

// Where a camera ray meets the board's plane, mm in the camera frame.
Eigen::Vector3d on_board_plane(const RigidTransform& camera_from_board, const Eigen::Vector3d& camera_ray);

// What a residual is about.
enum class CornerKind {
  camera,    // a printed corner in the camera's picture
  captured,  // a printed corner in the projector's, by Gray code
  projected  // a projected corner
};
CornerKind kind_of(const PoseObservation& pose, std::size_t residual);

// Standard deviations of one coordinate of each kind, px.
struct CornerSigmas {
  double camera_px = 1;
  double captured_px = 1;
  double projected_px = 1;

  [[nodiscard]] double of(CornerKind kind) const;
};

inline std::size_t camera_count(const PoseObservation& pose) {
  return pose.in_camera.size();
}
inline std::size_t projector_count(const PoseObservation& pose) {
  return pose.in_projector.size() + pose.projected.size();
}

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& rotation_vector);

}  // namespace bodyscan
