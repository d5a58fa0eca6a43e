#include "tools/evaluate/evaluation.hpp"

#include <cstdarg>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

class Table {
 public:
  [[gnu::format(printf, 3, 4)]] void line(const char* name, const char* format, ...) {
    char value[256];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(value, sizeof value, format, arguments);
    va_end(arguments);
    char whole[320];
    std::snprintf(whole, sizeof whole, "%-28s %s\n", name, value);
    text_ += whole;
  }
  [[nodiscard]] std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

void add_shapes(Table& table, const Evaluation& evaluation) {
  for (const StepResult& step : evaluation.steps) {
    table.line(step.name.c_str(), "height %+.4f mm, step %+.4f mm, noise %.3f mm (%zu points)",
               step.height_error_mm, step.step_error_mm, step.noise_mm, step.points);
  }
  for (const SphereResult& sphere : evaluation.spheres) {
    table.line("sphere", "diameter %+.4f mm, form %.3f mm (%zu points)", sphere.diameter_error_mm,
               sphere.form_mm, sphere.points);
  }
  if (evaluation.spheres.size() >= 2) {
    table.line("sphere spacing", "%+.4f mm", evaluation.sphere_spacing_error_mm);
  }
  for (const PlaneResult& plane : evaluation.planes) {
    table.line(plane.name.c_str(), "flatness %.3f mm, noise %.4f mm (%zu points)", plane.flatness_mm,
               plane.noise_mm, plane.points);
  }
  for (const BumpResult& bump : evaluation.bumps) {
    char name[64];
    std::snprintf(name, sizeof name, "bump %g mm, %g mm high", bump.diameter_mm, bump.height_mm);
    table.line(name, "%.3f of the relief kept (%zu bumps, %zu points)", bump.kept, bump.bumps, bump.points);
  }
  for (const MoleResult& mole : evaluation.moles) {
    char name[64];
    std::snprintf(name, sizeof name, "mole %.1f mm", mole.diameter_mm);
    table.line(name, "%.3f of the contrast kept, %.4f covered", mole.contrast_kept, mole.covered);
  }
}

}  // namespace

std::string to_table(const Evaluation& evaluation) {
  const Statistics& off = evaluation.deviation;
  Table table;
  table.line("points", "%zu", evaluation.points);
  table.line("faces", "%zu", evaluation.faces);
  table.line("RMS", "%.4f mm", off.rms);
  table.line("bias", "%+.4f mm", off.bias);
  table.line("MAD", "%.4f mm", off.mad);
  table.line("50 / 95 / 99.7 percentile", "%.4f / %.4f / %.4f mm", off.p50, off.p95, off.p997);
  table.line("99.7 % range", "%.4f mm", off.range_997);
  table.line("share over 1 mm", "%.7f", evaluation.share_wrong);
  table.line("completeness", "%.5f (%zu of %zu reachable pixels)", evaluation.coverage.completeness(),
             evaluation.coverage.covered, evaluation.coverage.reachable);
  add_shapes(table, evaluation);
  return std::move(table).text();
}

std::string to_json(const Evaluation& evaluation) {
  using nlohmann::ordered_json;
  const Statistics& off = evaluation.deviation;
  ordered_json object{{"points", evaluation.points},
                      {"faces", evaluation.faces},
                      {"rms_mm", off.rms},
                      {"bias_mm", off.bias},
                      {"mad_mm", off.mad},
                      {"p50_mm", off.p50},
                      {"p95_mm", off.p95},
                      {"p997_mm", off.p997},
                      {"range_997_mm", off.range_997},
                      {"share_over_1mm", evaluation.share_wrong},
                      {"completeness", evaluation.coverage.completeness()},
                      {"reachable_pixels", evaluation.coverage.reachable},
                      {"covered_pixels", evaluation.coverage.covered}};
  for (const StepResult& step : evaluation.steps) {
    object["steps"].push_back({{"name", step.name},
                               {"points", step.points},
                               {"height_error_mm", step.height_error_mm},
                               {"step_error_mm", step.step_error_mm},
                               {"noise_mm", step.noise_mm}});
  }
  for (const SphereResult& sphere : evaluation.spheres) {
    object["spheres"].push_back({{"points", sphere.points},
                                 {"diameter_error_mm", sphere.diameter_error_mm},
                                 {"form_mm", sphere.form_mm}});
  }
  if (evaluation.spheres.size() >= 2) object["sphere_spacing_error_mm"] = evaluation.sphere_spacing_error_mm;
  for (const PlaneResult& plane : evaluation.planes) {
    object["planes"].push_back({{"name", plane.name},
                                {"points", plane.points},
                                {"flatness_mm", plane.flatness_mm},
                                {"noise_mm", plane.noise_mm}});
  }
  for (const BumpResult& bump : evaluation.bumps) {
    object["bumps"].push_back({{"diameter_mm", bump.diameter_mm},
                               {"height_mm", bump.height_mm},
                               {"bumps", bump.bumps},
                               {"points", bump.points},
                               {"relief_kept", bump.kept}});
  }
  for (const MoleResult& mole : evaluation.moles) {
    object["moles"].push_back({{"diameter_mm", mole.diameter_mm},
                               {"pixels", mole.pixels},
                               {"covered", mole.covered},
                               {"contrast_kept", mole.contrast_kept}});
  }
  return object.dump(2) + "\n";
}

}  // namespace bodyscan
