#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/model/mesh.hpp"
#include "tools/evaluate/deviation.hpp"
#include "tools/evaluate/moles.hpp"
#include "tools/evaluate/shapes.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace bodyscan {

// Everything a model is judged by; lists are empty where the scene has no such thing.
struct Evaluation {
  std::size_t points = 0;
  std::size_t faces = 0;
  Statistics deviation;    // all points, mm
  double share_wrong = 0;  // of all points, farther off than wrong_mm
  Coverage coverage;
  std::vector<StepResult> steps;
  std::vector<SphereResult> spheres;
  double sphere_spacing_error_mm = 0;
  std::vector<PlaneResult> planes;
  std::vector<BumpResult> bumps;
  std::vector<MoleResult> moles;

  // Largest absolute value over the list; 0 for an empty one.
  [[nodiscard]] double worst_step_mm() const;
  [[nodiscard]] double worst_diameter_mm() const;
  [[nodiscard]] double worst_form_mm() const;
  [[nodiscard]] double worst_flatness_mm() const;
  // Least share kept of bumps of that diameter and height; 0 where there are none.
  [[nodiscard]] double bump_kept(double diameter_mm, double height_mm) const;
  // Median over the moles; 0 without moles.
  [[nodiscard]] double median_mole_contrast() const;
  // Least share of a mole's pixels that the model covers; 0 without moles.
  [[nodiscard]] double least_mole_coverage() const;
};

// `white` is the capture's white frame; an empty image leaves the moles out.
Evaluation evaluate(const Truth& truth, const Mesh& model, const ColorImage8& white);

// Reads the model and the simulator's capture folder, truth and white frame included.
Expected<Evaluation> evaluate_files(const std::filesystem::path& model,
                                    const std::filesystem::path& capture_dir);

std::string to_table(const Evaluation& evaluation);  // for people, one figure a line
std::string to_json(const Evaluation& evaluation);   // one object

}  // namespace bodyscan
