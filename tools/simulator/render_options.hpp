#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/pattern/sequence.hpp"
#include "tools/simulator/rig.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

#include <Eigen/Core>

namespace bodyscan::simulator {

enum class FrameFormat { jpeg, png };

// One simulated capture.
struct RenderOptions {
  std::string subject = "builtin:spheres";   // or an OBJ file, mm, y up, z towards the viewer
  std::string calibration = "builtin:rows";  // or a calibration file
  RigOptions rig;                            // of a built-in calibration; its name is taken from there

  std::string material = "own";  // own, matt, skin
  double detail = 0.5;           // mm: longest triangle side of the built-in body parts
  double subject_scale = 1;
  Eigen::Vector3d pose_rotation = Eigen::Vector3d::Zero();     // rotation vector, degrees
  Eigen::Vector3d pose_translation = Eigen::Vector3d::Zero();  // mm, added to (0, 0, 1050)
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();            // mm a frame

  double light = 1;          // 1: a matt surface facing the projector at 1.05 m reaches 75 % of full scale
  double contrast = 400;     // of the projector, white over black
  double ambient = 0.004;    // of full scale, off a matt surface
  double reflection = 0.03;  // inter-reflected share of the pattern's mean
  double defocus = 0.55;     // projector px, standard deviation
  double subsurface = -1;    // share of green light that scatters; negative: 0.5 for skin, 0 else
  double subsurface_blur = 2.4;  // projector px, standard deviation
  double uneven_light = 0;       // share of the projector's light that is lost at its picture's last pixel,
                                 // falling linearly from none at the first
  int rays = 2;                  // a side of the pixel
  double lens_blur = 0;          // camera px, standard deviation

  double full_well = 22000;  // electrons; 0: no noise
  double read_noise = 12;    // electrons
  std::uint64_t seed = 1;
  FrameFormat format = FrameFormat::jpeg;
  int jpeg_quality = 95;

  SequenceOptions sequence;
  std::filesystem::path output;
  bool write_mesh = true;

  // An error of kind `usage` that names the command line's option.
  [[nodiscard]] Expected<void> check() const;
};

}  // namespace bodyscan::simulator
