#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace bodyscan {

// What a scene must reach at a quarter of the camera's resolution (1072 x 712); lengths in mm. A figure that
// is absent is not judged: the scene has no such shape. Each is about 15 % above what was measured.
struct Thresholds {
  std::string scene;
  double rms;
  double share_wrong;   // of all points, farther off than 1 mm
  double completeness;  // at least
  std::optional<double> step = {};
  std::optional<double> sphere_spacing = {};
  std::optional<double> sphere_diameter = {};
  std::optional<double> sphere_form = {};
  std::optional<double> flatness = {};
  std::optional<double> bump_3mm_kept = {};  // of 0.5 mm high bumps, at least
  std::optional<double> bump_5mm_kept = {};
  std::optional<double> mole_contrast = {};  // median, at least
  std::optional<double> mole_coverage = {};  // of the mole with the most holes, at least
};

// The scene's name, for GoogleTest's messages.
inline void PrintTo(const Thresholds& one, std::ostream* out) {
  *out << one.scene;
}

std::vector<Thresholds> thresholds();

}  // namespace bodyscan
