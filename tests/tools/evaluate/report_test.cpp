#include "tools/evaluate/evaluation.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

Evaluation example() {
  Evaluation result;
  result.points = 1000;
  result.faces = 1900;
  result.deviation.rms = 0.031;
  result.share_wrong = 0.002;
  result.coverage = {.reachable = 400, .covered = 399};
  result.steps = {{"step 100", 10, 0.01, 0.02, 0}, {"step 101", 10, -0.02, 0.02, -0.03}};
  result.spheres = {{10, {}, 0.02, 0.1}, {10, {}, -0.05, 0.2}};
  result.sphere_spacing_error_mm = 0.004;
  result.planes = {{"plate", 10, 0.15, 0.02}};
  result.bumps = {{3, 0.5, 8, 90, 0.87}, {5, 0.5, 8, 200, 0.95}};
  result.moles = {{3, 50, 1, 0.9}, {4, 60, 0.8, 0.7}, {5, 70, 1, 0.98}};
  return result;
}

TEST(Evaluation, SumsUpItsLists) {
  const Evaluation result = example();
  EXPECT_DOUBLE_EQ(result.worst_step_mm(), 0.03);
  EXPECT_DOUBLE_EQ(result.worst_diameter_mm(), 0.05);
  EXPECT_DOUBLE_EQ(result.worst_form_mm(), 0.2);
  EXPECT_DOUBLE_EQ(result.worst_flatness_mm(), 0.15);
  EXPECT_DOUBLE_EQ(result.bump_kept(3, 0.5), 0.87);
  EXPECT_DOUBLE_EQ(result.bump_kept(3, 0.2), 0);
  EXPECT_NEAR(result.median_mole_contrast(), 0.9, 1e-6);
  EXPECT_DOUBLE_EQ(result.least_mole_coverage(), 0.8);
  EXPECT_EQ(Evaluation{}.least_mole_coverage(), 0);
}

TEST(Evaluation, JsonHoldsEveryFigure) {
  const nlohmann::json object = nlohmann::json::parse(to_json(example()));
  EXPECT_EQ(object.at("points"), 1000);
  EXPECT_EQ(object.at("rms_mm"), 0.031);
  EXPECT_EQ(object.at("share_over_1mm"), 0.002);
  EXPECT_EQ(object.at("completeness"), 399.0 / 400);
  EXPECT_EQ(object.at("steps").at(1).at("step_error_mm"), -0.03);
  EXPECT_EQ(object.at("spheres").at(1).at("form_mm"), 0.2);
  EXPECT_EQ(object.at("sphere_spacing_error_mm"), 0.004);
  EXPECT_EQ(object.at("planes").at(0).at("flatness_mm"), 0.15);
  EXPECT_EQ(object.at("bumps").at(1).at("relief_kept"), 0.95);
  EXPECT_EQ(object.at("moles").at(2).at("contrast_kept"), 0.98);
}

TEST(Evaluation, TableNamesEveryShape) {
  const std::string table = to_table(example());
  for (const char* text : {"RMS", "0.0310 mm", "share over 1 mm", "0.99750 (399 of 400", "step 101",
                           "sphere spacing", "plate", "bump 3 mm, 0.5 mm high", "mole 4.0 mm"}) {
    EXPECT_NE(table.find(text), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace bodyscan
