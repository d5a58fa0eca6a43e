#include "app/model_report.hpp"

#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

ModelReport sample() {
  ModelReport report;
  report.points = 5;
  report.faces = 6;
  report.pixels_lit = 8;
  report.pixels_decoded = 7;
  report.artifacts_removed = {{"isolated_points", 2}, {"flying_pixels", 1}};
  report.mean_uncertainty_mm = 0.025;
  report.timings_ms = {{"decode", 12.5}, {"write", 3}};
  report.peak_memory_bytes = 1'000'000;
  report.software = "bodyscan 1.2.3+0123456789";
  report.calibration = "rig.yml (CRC-32 01234567)";
  return report;
}

TEST(ModelReport, HoldsEveryFigureUnderItsKey) {
  const auto json = nlohmann::ordered_json::parse(to_json(sample()));
  EXPECT_EQ(json, nlohmann::ordered_json::parse(R"json({
    "points": 5, "faces": 6, "pixels_lit": 8, "pixels_decoded": 7, "decoded_fraction": 0.875,
    "artifacts_removed": {"isolated_points": 2, "flying_pixels": 1}, "mean_uncertainty_mm": 0.025,
    "timings_ms": {"decode": 12.5, "write": 3.0}, "peak_memory_bytes": 1000000,
    "software": "bodyscan 1.2.3+0123456789", "calibration": "rig.yml (CRC-32 01234567)"
})json"));
}

TEST(ModelReport, FractionOfNothingIsZero) {
  ModelReport report = sample();
  report.pixels_lit = report.pixels_decoded = 0;
  EXPECT_EQ(nlohmann::json::parse(to_json(report)).at("decoded_fraction"), 0.0);
}

TEST(ModelReport, FileNameThatIsNoUtf8IsStillJson) {
  ModelReport report = sample();
  report.calibration = "caf\xe9.yml";
  EXPECT_TRUE(nlohmann::json::accept(to_json(report)));
}

}  // namespace
}  // namespace bodyscan
