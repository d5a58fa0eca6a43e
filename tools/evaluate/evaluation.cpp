#include "tools/evaluate/evaluation.hpp"

#include "hal/replay/capture_folder.hpp"
#include "pipeline/model/vrml_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bodyscan {
namespace {

template <class Result, class Member>
double worst(const std::vector<Result>& results, Member member) {
  double largest = 0;
  for (const Result& result : results) largest = std::max(largest, std::abs(result.*member));
  return largest;
}

}  // namespace

double Evaluation::worst_step_mm() const {
  return worst(steps, &StepResult::step_error_mm);
}
double Evaluation::worst_diameter_mm() const {
  return worst(spheres, &SphereResult::diameter_error_mm);
}
double Evaluation::worst_form_mm() const {
  return worst(spheres, &SphereResult::form_mm);
}
double Evaluation::worst_flatness_mm() const {
  return worst(planes, &PlaneResult::flatness_mm);
}

double Evaluation::bump_kept(double diameter_mm, double height_mm) const {
  for (const BumpResult& bump : bumps) {
    if (std::abs(bump.diameter_mm - diameter_mm) < 1e-6 && std::abs(bump.height_mm - height_mm) < 1e-6) {
      return bump.kept;
    }
  }
  return 0;
}

double Evaluation::median_mole_contrast() const {
  std::vector<float> contrasts;
  for (const MoleResult& mole : moles) contrasts.push_back(static_cast<float>(mole.contrast_kept));
  return quantile(contrasts, 0.5);
}

double Evaluation::least_mole_coverage() const {
  double least = moles.empty() ? 0 : 1;
  for (const MoleResult& mole : moles) least = std::min(least, mole.covered);
  return least;
}

Evaluation evaluate(const Truth& truth, const Mesh& model, const ColorImage8& white) {
  const Deviations deviations = measure_deviations(truth, model.points);
  Evaluation result;
  result.points = model.points.size();
  result.faces = model.faces.size();
  result.deviation = summarize(deviations.distance);
  result.share_wrong = share_wrong(deviations);
  result.coverage = measure_coverage(truth, deviations);
  result.steps = measure_steps(truth, model.points, deviations);
  result.spheres = measure_spheres(truth, model.points, deviations);
  result.sphere_spacing_error_mm = sphere_spacing_error(truth, result.spheres);
  result.planes = measure_planes(truth, model.points, deviations);
  result.bumps = measure_bumps(truth, model.points, deviations);
  result.moles = measure_moles(truth, model, white);
  return result;
}

Expected<Evaluation> evaluate_files(const std::filesystem::path& model,
                                    const std::filesystem::path& capture_dir) {
  const Expected<Truth> truth = read_truth(capture_dir);
  if (!truth) return tl::unexpected(truth.error());
  const Expected<CaptureFolder> capture = CaptureFolder::open(capture_dir);
  if (!capture) return tl::unexpected(capture.error());
  const Expected<ColorImage8> white = capture->load_white_color();
  if (!white) return tl::unexpected(white.error());
  const Expected<VrmlModel> read = read_model(model);
  if (!read) return tl::unexpected(read.error());
  return evaluate(*truth, read->mesh, *white);
}

}  // namespace bodyscan
