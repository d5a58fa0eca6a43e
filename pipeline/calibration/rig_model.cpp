#include "pipeline/calibration/rig_model.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace bodyscan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double behind_px = 1e4;
constexpr std::array<const char*, lens_parameters> lens_names{"fx", "fy / fx", "cx", "cy", "k1",
                                                              "k2", "p1",      "p2", "k3"};
constexpr std::array<const char*, 6> extrinsic_names{"rotation x",    "rotation y",    "rotation z",
                                                     "translation x", "translation y", "translation z"};

// Lens distortion's index of a parameter from k1 on.
std::size_t distortion_index(LensParameter parameter) {
  switch (parameter) {
    case LensParameter::k1:
      return 0;
    case LensParameter::k2:
      return 1;
    case LensParameter::p1:
      return 2;
    case LensParameter::p2:
      return 3;
    default:
      return 4;
  }
}

void move_lens(Lens& lens, LensParameter parameter, double change) {
  switch (parameter) {
    case LensParameter::focal: {
      const double aspect = lens.fy / lens.fx;
      lens.fx += change;
      lens.fy = aspect * lens.fx;
      return;
    }
    case LensParameter::aspect:
      lens.fy += change * lens.fx;
      return;
    case LensParameter::cx:
      lens.cx += change;
      return;
    case LensParameter::cy:
      lens.cy += change;
      return;
    default:
      lens.distortion[distortion_index(parameter)] += change;
  }
}

double lens_value(const Lens& lens, LensParameter parameter) {
  switch (parameter) {
    case LensParameter::focal:
      return lens.fx;
    case LensParameter::aspect:
      return lens.fy / lens.fx;
    case LensParameter::cx:
      return lens.cx;
    case LensParameter::cy:
      return lens.cy;
    default:
      return lens.distortion[distortion_index(parameter)];
  }
}

Vector2d residual_of(const Lens& lens, const Vector3d& point, const Vector2d& measured) {
  if (!(point.z() > 1e-6)) return {behind_px, behind_px};
  const Vector2d residual = measured - lens.project(point);
  return residual.allFinite() ? residual : Vector2d(behind_px, behind_px);
}

}  // namespace

int position_in(const ParameterMask& mask, int parameter) {
  return static_cast<int>((mask << static_cast<std::size_t>(shared_parameters - parameter)).count());
}

std::string parameter_name(int parameter) {
  if (parameter < 2 * lens_parameters)
    return std::string(parameter < lens_parameters ? "camera " : "projector ") +
           lens_names[static_cast<std::size_t>(parameter % lens_parameters)];
  return extrinsic_names[static_cast<std::size_t>(parameter - 2 * lens_parameters)];
}

double parameter_value(const Calibration& calibration, int parameter) {
  if (parameter < lens_parameters)
    return lens_value(calibration.camera, static_cast<LensParameter>(parameter));
  if (parameter < 2 * lens_parameters)
    return lens_value(calibration.projector, static_cast<LensParameter>(parameter - lens_parameters));
  const int index = parameter - 2 * lens_parameters;
  return index < 3 ? 0 : calibration.projector_from_camera.translation[index - 3];
}

Calibration moved(Calibration calibration, int parameter, double change) {
  if (parameter < lens_parameters)
    move_lens(calibration.camera, static_cast<LensParameter>(parameter), change);
  else if (parameter < 2 * lens_parameters)
    move_lens(calibration.projector, static_cast<LensParameter>(parameter - lens_parameters), change);
  else
    calibration.projector_from_camera =
        moved(calibration.projector_from_camera, parameter - 2 * lens_parameters, change);
  return calibration;
}

RigidTransform moved(RigidTransform transform, int parameter, double change) {
  if (parameter < 3)
    transform.rotation = rotation_of(change * Vector3d::Unit(parameter)) * transform.rotation;
  else
    transform.translation[parameter - 3] += change;
  return transform;
}

double parameter_step(int parameter, const Calibration& calibration) {
  if (parameter >= 2 * lens_parameters) return pose_step(parameter - 2 * lens_parameters);
  const Lens& lens = parameter < lens_parameters ? calibration.camera : calibration.projector;
  switch (static_cast<LensParameter>(parameter % lens_parameters)) {
    case LensParameter::focal:
      return 1e-6 * lens.fx;
    case LensParameter::cx:
    case LensParameter::cy:
      return 1e-3;
    case LensParameter::k2:
      return 1e-5;
    case LensParameter::k3:
      return 1e-4;
    default:
      return 1e-6;
  }
}

double pose_step(int parameter) {
  return parameter < 3 ? 1e-7 : 1e-4;
}

Eigen::Matrix3d rotation_of(const Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

Vector3d on_board_plane(const RigidTransform& camera_from_board, const Vector3d& camera_ray) {
  const Vector3d normal = camera_from_board.rotation.col(2);
  return camera_ray * (normal.dot(camera_from_board.translation) / normal.dot(camera_ray));
}

std::vector<Vector3d> beam_rays(const Lens& camera, const PoseObservation& pose) {
  std::vector<Vector3d> rays;
  for (const Beam& beam : pose.projected) rays.push_back(camera.ray(beam.camera_px));
  return rays;
}

void predict_residuals(const Calibration& calibration, const RigidTransform& camera_from_board,
                       const PrintedBoard& board, const PoseObservation& pose, std::span<const Vector3d> rays,
                       std::vector<Vector2d>& residuals) {
  residuals.clear();
  const auto corner = [&](int index) {
    Vector3d point = Vector3d::Zero();
    point.head<2>() = board.corner_mm(index);
    return Vector3d(camera_from_board * point);
  };
  for (const SeenCorner& seen : pose.in_camera)
    residuals.push_back(residual_of(calibration.camera, corner(seen.corner), seen.px));
  for (const SeenCorner& seen : pose.in_projector)
    residuals.push_back(
        residual_of(calibration.projector, calibration.projector_from_camera * corner(seen.corner), seen.px));
  for (std::size_t i = 0; i < pose.projected.size(); ++i) {
    const Vector3d point = on_board_plane(camera_from_board, rays[i]);
    residuals.push_back(residual_of(calibration.projector, calibration.projector_from_camera * point,
                                    pose.projected[i].projector_px));
  }
}

void predict_residuals(const Calibration& calibration, const RigidTransform& camera_from_board,
                       const PrintedBoard& board, const PoseObservation& pose,
                       std::vector<Vector2d>& residuals) {
  predict_residuals(calibration, camera_from_board, board, pose, beam_rays(calibration.camera, pose),
                    residuals);
}

CornerKind kind_of(const PoseObservation& pose, std::size_t residual) {
  if (residual < camera_count(pose)) return CornerKind::camera;
  return residual < camera_count(pose) + pose.in_projector.size() ? CornerKind::captured
                                                                  : CornerKind::projected;
}

double CornerSigmas::of(CornerKind kind) const {
  if (kind == CornerKind::camera) return camera_px;
  return kind == CornerKind::captured ? captured_px : projected_px;
}

}  // namespace bodyscan
