#include "app/calibration_report_json.hpp"

#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

Calibration sample_calibration() {
  Calibration calibration;
  calibration.camera = {.size = {4288, 2848},
                        .fx = 5500.5,
                        .fy = 5501,
                        .cx = 2143,
                        .cy = 1424,
                        .distortion = {-0.1, 0.2, 0.003, 0, 0.5}};
  calibration.projector = {
      .size = {1024, 768}, .fx = 1500, .fy = 1499, .cx = 512, .cy = 384, .distortion = {}};
  calibration.projector_from_camera.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  calibration.projector_from_camera.translation = {3, 4, 0};
  return calibration;
}

CalibrationReport sample_calibration_report() {
  CalibrationReport report;
  report.camera_rms_px = 0.25;
  report.projector_rms_px = 0.5;
  report.joint_rms_px = 0.375;
  report.corners = 126;
  report.corners_left_out = 5;
  report.all_camera_rms_px = 0.5;
  report.all_projector_rms_px = 0.75;
  report.leave_one_out_camera_px = 1;
  report.leave_one_out_projector_px = 2;
  report.square_error_percent = -0.125;
  report.square_spread_percent = 0.75;
  report.leave_one_out_square_error_percent = 0.0625;
  report.relative_uncertainty = 0.0009765625;
  report.verdict = "good";
  report.parameters = {{"camera fx", 5500.5, 0.5}, {"camera k3", 0, std::nullopt, false}};
  PoseReport pose;
  pose.name = "pose 0";
  pose.used = false;
  pose.reason = "too dark";
  pose.notes = {"held aslant"};
  pose.camera_rms_px = 3;
  pose.projector_rms_px = 4;
  pose.distance_mm = 800;
  pose.tilt_degrees = 20;
  pose.plane_rms_mm = 0.5;
  pose.camera_from_board.translation = {1, 2, 800};
  pose.camera = {{{10, 20}, {0.5, -0.25}, true}, {{30, 40}, {5, 6}, false}};
  pose.projector = {{{1, 2}, {3, 4}, true}};
  report.poses = {pose};
  report.advice = {"tilt the board more"};
  return report;
}

TEST(CalibrationReportJson, HoldsEverythingUnderItsKey) {
  const auto json =
      nlohmann::ordered_json::parse(to_json(sample_calibration_report(), sample_calibration(),
                                            {"bodyscan 1.2.3", {{"open", 1.5}, {"calibrate", 20}}}));
  EXPECT_EQ(json, nlohmann::ordered_json::parse(R"json({
    "camera_rms_px": 0.25, "projector_rms_px": 0.5, "joint_rms_px": 0.375,
    "corners": 126, "corners_left_out": 5, "all_camera_rms_px": 0.5, "all_projector_rms_px": 0.75,
    "leave_one_out_camera_px": 1.0, "leave_one_out_projector_px": 2.0,
    "square_error_percent": -0.125, "square_spread_percent": 0.75, "leave_one_out_square_error_percent": 0.0625,
    "relative_uncertainty": 0.0009765625, "verdict": "good",
    "advice": ["tilt the board more"],
    "calibration": {
      "camera": {"size": [4288, 2848], "fx": 5500.5, "fy": 5501.0, "cx": 2143.0, "cy": 1424.0,
                 "distortion": [-0.1, 0.2, 0.003, 0.0, 0.5]},
      "projector": {"size": [1024, 768], "fx": 1500.0, "fy": 1499.0, "cx": 512.0, "cy": 384.0,
                    "distortion": [0.0, 0.0, 0.0, 0.0, 0.0]},
      "projector_from_camera": {"rotation": [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
                                "translation_mm": [3.0, 4.0, 0.0]},
      "baseline_mm": 5.0
    },
    "parameters": [{"name": "camera fx", "value": 5500.5, "sigma": 0.5, "estimated": true},
                   {"name": "camera k3", "value": 0.0, "sigma": null, "estimated": false}],
    "poses": [{
      "name": "pose 0", "used": false, "reason": "too dark", "notes": ["held aslant"], "camera_rms_px": 3.0, "projector_rms_px": 4.0,
      "distance_mm": 800.0, "tilt_degrees": 20.0, "plane_rms_mm": 0.5,
      "camera_from_board": {"rotation": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
                            "translation_mm": [1.0, 2.0, 800.0]},
      "camera": [{"at": [10.0, 20.0], "error": [0.5, -0.25], "used": true},
                 {"at": [30.0, 40.0], "error": [5.0, 6.0], "used": false}],
      "projector": [{"at": [1.0, 2.0], "error": [3.0, 4.0], "used": true}]
    }],
    "timings_ms": {"open": 1.5, "calibrate": 20.0},
    "software": "bodyscan 1.2.3"
  })json"));
}

TEST(CalibrationReportJson, NumbersThatAreNoneBecomeNull) {
  CalibrationReport report = sample_calibration_report();
  report.leave_one_out_camera_px = std::numeric_limits<double>::quiet_NaN();
  report.parameters[0].sigma = std::numeric_limits<double>::infinity();
  report.poses[0].camera[0].error.x() = -std::numeric_limits<double>::infinity();
  const auto json = nlohmann::json::parse(to_json(report, sample_calibration(), {}));
  EXPECT_TRUE(json["leave_one_out_camera_px"].is_null());
  EXPECT_TRUE(json["parameters"][0]["sigma"].is_null());
  EXPECT_TRUE(json["poses"][0]["camera"][0]["error"][0].is_null());
}

TEST(CalibrationReportJson, WhatIsNotKnownIsNull) {
  CalibrationReport report = sample_calibration_report();
  report.leave_one_out_projector_px.reset();
  report.square_error_percent.reset();
  report.square_spread_percent.reset();
  report.poses[0].located = false;
  const auto json = nlohmann::json::parse(to_json(report, sample_calibration(), {}));
  for (const char* key : {"leave_one_out_projector_px", "square_error_percent", "square_spread_percent"})
    EXPECT_TRUE(json[key].is_null()) << key;
  for (const char* key : {"camera_rms_px", "projector_rms_px", "distance_mm", "tilt_degrees", "plane_rms_mm",
                          "camera_from_board"})
    EXPECT_TRUE(json["poses"][0][key].is_null()) << key;
}

TEST(CalibrationReportJson, AReportOfNothingHasEmptyLists) {
  const auto json = nlohmann::json::parse(to_json({}, {}, {"caf\xe9", {}}));
  for (const char* list : {"advice", "parameters", "poses"})
    EXPECT_TRUE(json[list].is_array() && json[list].empty()) << list;
}

}  // namespace
}  // namespace bodyscan
