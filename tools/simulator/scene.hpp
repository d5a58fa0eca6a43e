#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/geometry/calibration.hpp"
#include "tools/simulator/render_options.hpp"
#include "tools/simulator/subject.hpp"

#include <Eigen/Core>

namespace bodyscan::simulator {

// A subject before the rig: mesh and facts are in the camera frame, mm.
struct Scene {
  Calibration calibration;
  Subject subject;
  // camera_from_subject: X_camera = scale * rotation * X_subject + translation
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  std::vector<MoleFact> moles_in_subject;

  [[nodiscard]] Eigen::Vector3d subject_point(const Eigen::Vector3d& camera_point) const {
    return rotation.transpose() * (camera_point - translation) / scale;
  }
};

// A built-in rig ("builtin:NAME", the rest of it as `rig` says) or a calibration file.
Expected<Calibration> find_calibration(const std::string& name, RigOptions rig);

// `subject` before the rig; `camera_from_subject` acts on the scaled subject.
Scene place_subject(const Calibration& calibration, Subject subject,
                    const RigidTransform& camera_from_subject, double scale = 1);

// Checks the options, reads the calibration and the subject and places it.
Expected<Scene> make_scene(const RenderOptions& options);

}  // namespace bodyscan::simulator
