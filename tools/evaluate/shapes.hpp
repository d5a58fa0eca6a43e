#pragma once

#include "tools/evaluate/deviation.hpp"

#include <string>
#include <vector>

namespace bodyscan {

// How well the known shapes of a scene come out of a model's points. A point belongs to the shape that the
// true surface at its pixel lies on; points that are off by more than `wrong_mm` are left to the share over 1
// mm.

// One step of a staircase. Its height error is the mean signed deviation of its face.
struct StepResult {
  std::string name;
  std::size_t points = 0;
  double height_error_mm = 0;
  double noise_mm = 0;       // standard deviation of the face's points
  double step_error_mm = 0;  // this height error minus the previous step's; 0 for the first
};

// Least-squares sphere.
struct SphereResult {
  std::size_t points = 0;
  Sphere fitted;
  double diameter_error_mm = 0;
  double form_mm = 0;  // 99.7 % range of the residuals
};

// Least-squares plane.
struct PlaneResult {
  std::string name;
  std::size_t points = 0;
  double flatness_mm = 0;  // 99.7 % range of the residuals
  double noise_mm = 0;     // their RMS
};

// All bumps of one diameter and height. Relief is the signed distance to the base plane, less the mean of a
// ring of flat surface around the bump (0.3 to 1.5 mm outside its rim).
struct BumpResult {
  double diameter_mm = 0;
  double height_mm = 0;
  std::size_t bumps = 0;
  std::size_t points = 0;
  double kept = 0;  // slope of the regression of measured on true relief inside the bumps
};

std::vector<StepResult> measure_steps(const Truth& truth, std::span<const Point3f> points,
                                      const Deviations& deviations);
std::vector<SphereResult> measure_spheres(const Truth& truth, std::span<const Point3f> points,
                                          const Deviations& deviations);
// The first two spheres' distance, fitted minus true; 0 with fewer than two.
double sphere_spacing_error(const Truth& truth, const std::vector<SphereResult>& spheres);
std::vector<PlaneResult> measure_planes(const Truth& truth, std::span<const Point3f> points,
                                        const Deviations& deviations);
std::vector<BumpResult> measure_bumps(const Truth& truth, std::span<const Point3f> points,
                                      const Deviations& deviations);

}  // namespace bodyscan
