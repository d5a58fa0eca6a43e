#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace bodyscan {

// A printed corner where a device sees it.
struct SeenCorner {
  int corner = 0;  // index as of PrintedBoard::corner_mm
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
};

// A projected corner: the projector pixel it leaves from and the camera pixel it is seen at.
struct Beam {
  Eigen::Vector2d projector_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d camera_px = Eigen::Vector2d::Zero();
};

// What one pose of the board tells: a Gray-code pose fills `in_projector`, a pair of pictures `projected`.
struct PoseObservation {
  std::string name;  // "pose 4"
  std::vector<SeenCorner> in_camera;
  std::vector<SeenCorner> in_projector;
  std::vector<Beam> projected;
};

// The corners of a pose whose weights, in the order of predict_residuals, are not 0.
PoseObservation fitting_corners(const PoseObservation& pose, const std::vector<double>& weights);

}  // namespace bodyscan
