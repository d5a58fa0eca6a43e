#include "tools/simulator/rig.hpp"

#include "tools/simulator/option_range.hpp"
#include "tools/simulator/subjects.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

namespace bodyscan::simulator {
namespace {

using Eigen::Vector3d;

Lens camera_lens(double scale) {
  Lens lens;
  lens.size = {static_cast<int>(std::lround(4288 * scale)), static_cast<int>(std::lround(2848 * scale))};
  lens.fx = lens.fy = 6360 * scale;
  lens.cx = (2143.5 + 11.0 + 0.5) * scale - 0.5;
  lens.cy = (1423.5 - 7.0 + 0.5) * scale - 0.5;
  lens.distortion = {-0.091, 0.113, 0.0004, -0.0003, 0};
  return lens;
}

Lens projector_lens(Size size) {
  Lens lens;
  lens.size = size;
  lens.fx = lens.fy = 1.47 * size.width;
  lens.cx = 0.5 * size.width - 0.5;
  lens.cy = 0.86 * size.height - 0.5;
  lens.distortion = {-0.021, 0.017, -0.0002, 0.0003, 0};
  return lens;
}

// The rotation R = R_y(yaw) R_x(pitch) that turns `from` onto `to` (both unit length) without any roll.
Eigen::Matrix3d aim(const Vector3d& from, const Vector3d& to) {
  const double radius = std::hypot(from.y(), from.z());
  const double pitch = std::acos(to.y() / radius) - std::atan2(from.z(), from.y());
  const Eigen::Matrix3d pitched = Eigen::AngleAxisd(pitch, Vector3d::UnitX()).toRotationMatrix();
  const Vector3d turned = pitched * from;
  const double yaw = std::atan2(to.x(), to.z()) - std::atan2(turned.x(), turned.z());
  return Eigen::AngleAxisd(yaw, Vector3d::UnitY()).toRotationMatrix() * pitched;
}

}  // namespace

Expected<void> check_projector_size(Size size, const std::string& option) {
  if (size.width < 16 || size.height < 16 || size.width > 8192 || size.height > 8192)
    return usage_error(option + ": must lie in 16x16 to 8192x8192");
  return {};
}

Expected<Calibration> make_rig(const RigOptions& options) {
  if (!(options.scale >= 1.0 / 64 && options.scale <= 2))
    return usage_error("--scale: must lie in 1/64 to 2");
  if (const Expected<void> fits = check_projector_size(options.projector, "--projector"); !fits)
    return tl::unexpected(fits.error());
  if (!std::isfinite(options.projector_roll)) return usage_error("--projector-roll: not finite");

  Vector3d position;
  if (options.name == "rows") {
    position = {0, 268, 0};
  } else if (options.name == "columns") {
    position = {272, 0, 0};
  } else if (options.name == "diagonal") {
    position = {190, 190, 0};
  } else {
    return usage_error("no built-in rig \"" + options.name + "\" (there are: rows, columns, diagonal)");
  }
  const double roll = options.projector_roll * std::numbers::pi / 180;
  const bool on_its_side = std::abs(std::sin(roll)) > std::abs(std::cos(roll));
  if (on_its_side && options.name == "rows") position = {272, 0, 0};
  if (on_its_side && options.name == "columns") position = {0, 268, 0};

  Calibration rig{camera_lens(options.scale), projector_lens(options.projector), {}};
  const Vector3d target(0, 0, reference_distance);
  const Eigen::Vector2d picture_center((options.projector.width - 1) / 2.0,
                                       (options.projector.height - 1) / 2.0);
  const Eigen::Matrix3d rolled = Eigen::AngleAxisd(roll, Vector3d::UnitZ()).toRotationMatrix();
  const Vector3d center_ray = rolled * rig.projector.ray(picture_center).normalized();
  const Eigen::Matrix3d camera_from_projector = aim(center_ray, (target - position).normalized()) * rolled;
  rig.projector_from_camera.rotation = camera_from_projector.transpose();
  rig.projector_from_camera.translation = -rig.projector_from_camera.rotation * position;
  return rig;
}

}  // namespace bodyscan::simulator
