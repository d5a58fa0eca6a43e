#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <opencv2/core.hpp>

namespace peer {

// (row axis, bit, inverted) -> file.
using GrayFiles = std::map<std::tuple<bool, int, bool>, std::string>;

struct Capture {
  cv::Size projector;
  std::string white;
  std::string black;
  GrayFiles gray;

  [[nodiscard]] int bits(bool rows) const;
};

struct Rig {
  cv::Matx33d camera;
  cv::Mat camera_distortion;
  cv::Matx33d projector;
  cv::Mat projector_distortion;
  cv::Matx33d rotation;  // projector_from_camera
  cv::Vec3d translation;
};

// Both throw std::exception: these programs stand beside the product for comparison only.
Capture read_capture(const std::string& folder);
Rig read_rig(const std::string& file);

// Camera and output of one run, as every peer's command line has it: CAPTURE_DIR CALIBRATION MODEL.wrl
void write_points(const std::string& file, const std::vector<cv::Point3f>& points,
                  const std::vector<cv::Vec3b>& colors);

}  // namespace peer
