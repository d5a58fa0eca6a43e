#include "tests/accuracy/thresholds.hpp"

namespace bodyscan {

std::vector<Thresholds> thresholds() {
  std::vector<Thresholds> all;
  all.push_back({.scene = "spheres", .rms = 0.037, .share_wrong = 8e-5, .completeness = 0.999});
  all.back().sphere_spacing = 0.003;
  all.back().sphere_diameter = 0.020;
  all.back().sphere_form = 0.12;
  all.back().flatness = 0.17;

  all.push_back({.scene = "staircase", .rms = 0.036, .share_wrong = 3e-5, .completeness = 0.999});
  all.back().step = 0.001;
  all.back().flatness = 0.16;

  all.push_back({.scene = "skin_head", .rms = 0.039, .share_wrong = 2e-5, .completeness = 0.999});
  all.back().mole_contrast = 0.95;
  all.back().mole_coverage = 0.75;

  all.push_back({.scene = "blur", .rms = 0.078, .share_wrong = 1e-4, .completeness = 0.995});
  all.back().mole_contrast = 0.95;
  all.back().mole_coverage = 0.75;

  all.push_back({.scene = "dim", .rms = 0.14, .share_wrong = 3e-4, .completeness = 0.99});
  all.back().mole_contrast = 0.85;
  all.back().mole_coverage = 0.50;

  all.push_back({.scene = "columns", .rms = 0.034, .share_wrong = 8e-5, .completeness = 0.999});
  all.back().sphere_spacing = 0.003;
  all.back().sphere_diameter = 0.014;
  all.back().sphere_form = 0.12;
  all.back().flatness = 0.175;

  all.push_back({.scene = "both", .rms = 0.032, .share_wrong = 8e-5, .completeness = 0.999});
  all.back().sphere_spacing = 0.003;
  all.back().sphere_diameter = 0.016;
  all.back().sphere_form = 0.105;
  all.back().flatness = 0.17;

  all.push_back({.scene = "bumps", .rms = 0.032, .share_wrong = 3e-5, .completeness = 0.999});
  all.back().flatness = 0.13;
  all.back().bump_3mm_kept = 0.60;
  all.back().bump_5mm_kept = 0.87;

  all.push_back({.scene = "bumps_skin", .rms = 0.044, .share_wrong = 3e-5, .completeness = 0.999});
  all.back().flatness = 0.29;
  all.back().bump_3mm_kept = 0.57;
  all.back().bump_5mm_kept = 0.81;

  all.push_back({.scene = "roll_90", .rms = 0.034, .share_wrong = 8e-5, .completeness = 0.999});
  all.back().sphere_spacing = 0.003;
  all.back().sphere_diameter = 0.012;
  all.back().sphere_form = 0.105;
  all.back().flatness = 0.175;

  all.push_back({.scene = "roll_180", .rms = 0.037, .share_wrong = 8e-5, .completeness = 0.999});
  all.back().sphere_spacing = 0.003;
  all.back().sphere_diameter = 0.020;
  all.back().sphere_form = 0.11;
  all.back().flatness = 0.17;

  all.push_back({.scene = "roll_30", .rms = 0.042, .share_wrong = 8e-5, .completeness = 0.999});
  all.back().sphere_spacing = 0.003;
  all.back().sphere_diameter = 0.014;
  all.back().sphere_form = 0.145;
  all.back().flatness = 0.22;
  return all;
}

}  // namespace bodyscan
