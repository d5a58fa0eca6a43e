#pragma once

#include "pipeline/base/image.hpp"
#include "pipeline/geometry/calibration.hpp"

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
  std::string reason;              // why it was left out
  std::vector<std::string> notes;  // what is noteworthy about one that was not
  bool located = true;             // false: where the board was is not known, nor what follows
  double camera_rms_px = 0;        // of the corners that fit, both directions together
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
  std::optional<double> sigma;  // standard deviation, of a fixed one before it was fixed; nothing: not known
  bool estimated = true;        // false: fixed, because the poses cannot tell it from its usual value
};

// How well a calibration is known and by what.
struct CalibrationReport {
  double camera_rms_px = 0;  // of the corners that fit, in the poses used
  double projector_rms_px = 0;
  double joint_rms_px = 0;  // camera and projector together

  int corners = 0;               // of both devices in the poses used
  int corners_left_out = 0;      // of those: they do not fit
  double all_camera_rms_px = 0;  // with these
  double all_projector_rms_px = 0;

  // Every pose under a calibration from the other poses, its board fitted to it.
  std::optional<double> leave_one_out_camera_px;
  std::optional<double> leave_one_out_projector_px;

  // The board's squares, triangulated from camera and projector: mean side over the printed one, less one,
  // and the sides' standard deviation, in percent. The same leaving each pose out of the calibration that
  // measures it. Nothing where no square could be triangulated.
  std::optional<double> square_error_percent;
  std::optional<double> square_spread_percent;
  std::optional<double> leave_one_out_square_error_percent;

  // Of focal lengths and baseline together, and what that is worth; nothing where the lenses were kept.
  std::optional<double> relative_uncertainty;
  std::string verdict;

  std::vector<ParameterReport> parameters;
  std::vector<PoseReport> poses;
  std::vector<std::string> advice;  // what the poses cannot determine, and which pose would help most
};

}  // namespace bodyscan
