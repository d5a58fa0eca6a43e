#include "app/calibration_report_json.hpp"

#include <nlohmann/json.hpp>

namespace bodyscan {
namespace {

using Json = nlohmann::ordered_json;

Json pair_of(const Eigen::Vector2d& point) {
  return {point.x(), point.y()};
}

Json json_of(const RigidTransform& transform) {
  Json rotation = Json::array();
  for (int row = 0; row < 3; ++row)
    rotation.push_back({transform.rotation(row, 0), transform.rotation(row, 1), transform.rotation(row, 2)});
  const Eigen::Vector3d& t = transform.translation;
  return {{"rotation", rotation}, {"translation_mm", {t.x(), t.y(), t.z()}}};
}

Json json_of(const Lens& lens) {
  return {{"size", {lens.size.width, lens.size.height}},
          {"fx", lens.fx},
          {"fy", lens.fy},
          {"cx", lens.cx},
          {"cy", lens.cy},
          {"distortion", lens.distortion}};
}

Json json_of(const Calibration& calibration) {
  return {{"camera", json_of(calibration.camera)},
          {"projector", json_of(calibration.projector)},
          {"projector_from_camera", json_of(calibration.projector_from_camera)},
          {"baseline_mm", calibration.projector_from_camera.translation.norm()}};
}

Json json_of(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json json_of(const ParameterReport& parameter) {
  return {{"name", parameter.name},
          {"value", parameter.value},
          {"sigma", json_of(parameter.sigma)},
          {"estimated", parameter.estimated}};
}

Json json_of(const std::vector<CornerResidual>& corners) {
  Json list = Json::array();
  for (const CornerResidual& corner : corners)
    list.push_back({{"at", pair_of(corner.at)}, {"error", pair_of(corner.error)}, {"used", corner.used}});
  return list;
}

Json json_of(const PoseReport& pose) {
  const auto if_located = [&](Json value) { return pose.located ? std::move(value) : Json(nullptr); };
  return {{"name", pose.name},
          {"used", pose.used},
          {"reason", pose.reason},
          {"notes", Json(pose.notes)},
          {"camera_rms_px", if_located(pose.camera_rms_px)},
          {"projector_rms_px", if_located(pose.projector_rms_px)},
          {"distance_mm", if_located(pose.distance_mm)},
          {"tilt_degrees", if_located(pose.tilt_degrees)},
          {"plane_rms_mm", if_located(pose.plane_rms_mm)},
          {"camera_from_board", if_located(json_of(pose.camera_from_board))},
          {"camera", json_of(pose.camera)},
          {"projector", json_of(pose.projector)}};
}

template <class Value>
Json list_of(const std::vector<Value>& values) {
  Json list = Json::array();
  for (const Value& value : values) list.push_back(json_of(value));
  return list;
}

}  // namespace

std::string to_json(const CalibrationReport& report, const Calibration& calibration,
                    const CalibrationRun& run) {
  Json timings = Json::object();
  for (const auto& [stage, milliseconds] : run.timings_ms) timings[stage] = milliseconds;
  const Json json = {
      {"camera_rms_px", report.camera_rms_px},
      {"projector_rms_px", report.projector_rms_px},
      {"joint_rms_px", report.joint_rms_px},
      {"corners", report.corners},
      {"corners_left_out", report.corners_left_out},
      {"all_camera_rms_px", report.all_camera_rms_px},
      {"all_projector_rms_px", report.all_projector_rms_px},
      {"leave_one_out_camera_px", json_of(report.leave_one_out_camera_px)},
      {"leave_one_out_projector_px", json_of(report.leave_one_out_projector_px)},
      {"square_error_percent", json_of(report.square_error_percent)},
      {"square_spread_percent", json_of(report.square_spread_percent)},
      {"leave_one_out_square_error_percent", json_of(report.leave_one_out_square_error_percent)},
      {"relative_uncertainty", json_of(report.relative_uncertainty)},
      {"verdict", report.verdict},
      {"advice", Json(report.advice)},
      {"calibration", json_of(calibration)},
      {"parameters", list_of(report.parameters)},
      {"poses", list_of(report.poses)},
      {"timings_ms", timings},
      {"software", run.software},
  };
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace bodyscan
