#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/calibration/calibration.hpp"

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace bodyscan {

// What is left of one corner after the fit: measured minus predicted.
struct CornerResidual {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();     // measured, px
  Eigen::Vector2d error = Eigen::Vector2d::Zero();  // px
  bool used = true;                                 // not left out as a false corner
};

struct PoseReport {
  std::string name;  // "pose 4", counted from 0 as in session.json
  bool used = true;
  std::string reason;        // why it was left out; or what is noteworthy, empty for nothing
  double camera_rms_px = 0;  // of the used corners, both directions together
  double projector_rms_px = 0;
  double distance_mm = 0;   // of the board's middle from the camera
  double tilt_degrees = 0;  // of the board's normal from the camera's axis
  double plane_rms_mm = 0;  // of the triangulated corners about their plane
  RigidTransform camera_from_board;
  std::vector<CornerResidual> camera;
  std::vector<CornerResidual> projector;
};

struct ParameterReport {
  std::string name;  // "camera fx"; lengths in px, mm; angles in degrees
  double value = 0;
  std::optional<double> sigma;  // standard deviation; nothing where it was not estimated but fixed
};

// How well a calibration is known and by what.
struct CalibrationReport {
  double camera_rms_px = 0;
  double projector_rms_px = 0;
  double joint_rms_px = 0;  // camera and projector together

  // Every pose predicted by a calibration from the other poses.
  double leave_one_out_camera_px = 0;
  double leave_one_out_projector_px = 0;

  // The board's squares, triangulated from camera and projector: mean side over the printed one, less one,
  // and the sides' standard deviation, in percent. The same leaving each pose out of the calibration that
  // measures it.
  double square_error_percent = 0;
  double square_spread_percent = 0;
  double leave_one_out_square_error_percent = 0;

  std::vector<ParameterReport> parameters;
  std::vector<PoseReport> poses;
  std::vector<std::string> advice;  // what the poses cannot determine, and which pose would help most
};

}  // namespace bodyscan
