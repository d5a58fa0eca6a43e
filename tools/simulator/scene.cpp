#include "tools/simulator/scene.hpp"

#include "pipeline/calibration/calibration_file.hpp"
#include "tools/simulator/obj_file.hpp"
#include "tools/simulator/subjects.hpp"

#include <numbers>
#include <utility>

#include <Eigen/Geometry>

namespace bodyscan::simulator {
namespace {

constexpr std::string_view builtin = "builtin:";

Expected<Subject> find_subject(const RenderOptions& options) {
  if (options.subject.starts_with(builtin))
    return make_builtin_subject(options.subject.substr(builtin.size()), options.detail);
  return read_obj(options.subject);
}

void place(Scene& scene) {
  const auto moved = [&](Eigen::Vector3d& point) {
    point = scene.scale * (scene.rotation * point) + scene.translation;
  };
  const Eigen::Matrix3f turned = scene.rotation.cast<float>();
  for (Eigen::Vector3d& point : scene.subject.mesh.points) moved(point);
  for (Eigen::Vector3f& normal : scene.subject.mesh.normals) normal = turned * normal;
  Facts& facts = scene.subject.facts;
  for (PlaneFact& plane : facts.planes) {
    for (Eigen::Vector3d& corner : plane.corners) moved(corner);
    plane.normal = scene.rotation * plane.normal;
    plane.height *= scene.scale;
  }
  for (SphereFact& sphere : facts.spheres) {
    moved(sphere.center);
    sphere.radius *= scene.scale;
  }
  for (BumpFact& bump : facts.bumps) {
    moved(bump.center);
    bump.normal = scene.rotation * bump.normal;
    bump.diameter *= scene.scale;
    bump.height *= scene.scale;
  }
  for (MoleFact& mole : facts.moles) {
    moved(mole.center);
    mole.diameter *= scene.scale;
  }
}

}  // namespace

Expected<Calibration> find_calibration(const std::string& name, RigOptions rig) {
  if (!name.starts_with(builtin)) return read_calibration(name);
  rig.name = name.substr(builtin.size());
  Expected<Calibration> calibration = make_rig(rig);
  if (!calibration && !calibration.error().message.starts_with("--"))
    return tl::unexpected(calibration.error().within("--calibration"));
  return calibration;
}

Scene place_subject(const Calibration& calibration, Subject subject,
                    const RigidTransform& camera_from_subject, double scale) {
  Scene scene;
  scene.calibration = calibration;
  scene.subject = std::move(subject);
  scene.scale = scale;
  scene.rotation = camera_from_subject.rotation;
  scene.translation = camera_from_subject.translation;
  scene.moles_in_subject = scene.subject.facts.moles;
  place(scene);
  return scene;
}

Expected<Scene> make_scene(const RenderOptions& options) {
  if (Expected<void> checked = options.check(); !checked) return tl::unexpected(checked.error());
  const Expected<Calibration> calibration = find_calibration(options.calibration, options.rig);
  if (!calibration) return tl::unexpected(calibration.error());
  Expected<Subject> subject = find_subject(options);
  if (!subject) return tl::unexpected(subject.error());

  if (options.material != "own") {
    subject->material = options.material == "skin" ? Material::skin : Material::matt;
    subject->mesh.albedo.clear();
    subject->mesh.textures_of.clear();
  }
  if (subject->material != Material::skin) subject->facts.moles.clear();
  RigidTransform pose;
  const Eigen::Vector3d rotation = options.pose_rotation * (std::numbers::pi / 180);
  if (rotation.norm() > 0)
    pose.rotation = Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix();
  pose.translation = Eigen::Vector3d(0, 0, reference_distance) + options.pose_translation;
  return place_subject(*calibration, std::move(*subject), pose, options.subject_scale);
}

}  // namespace bodyscan::simulator
