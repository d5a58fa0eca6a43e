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

Json json_of(const ParameterReport& parameter) {
  return {{"name", parameter.name},
          {"value", parameter.value},
          {"sigma", parameter.sigma ? Json(*parameter.sigma) : Json(nullptr)}};
}

Json json_of(const std::vector<CornerResidual>& corners) {
  Json list = Json::array();
  for (const CornerResidual& corner : corners)
    list.push_back({{"at", pair_of(corner.at)}, {"error", pair_of(corner.error)}, {"used", corner.used}});
  return list;
}

Json json_of(const PoseReport& pose) {
  return {{"name", pose.name},
          {"used", pose.used},
          {"reason", pose.reason},
          {"camera_rms_px", pose.camera_rms_px},
          {"projector_rms_px", pose.projector_rms_px},
          {"distance_mm", pose.distance_mm},
          {"tilt_degrees", pose.tilt_degrees},
          {"plane_rms_mm", pose.plane_rms_mm},
          {"camera_from_board", json_of(pose.camera_from_board)},
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
      {"leave_one_out_camera_px", report.leave_one_out_camera_px},
      {"leave_one_out_projector_px", report.leave_one_out_projector_px},
      {"square_error_percent", report.square_error_percent},
      {"square_spread_percent", report.square_spread_percent},
      {"leave_one_out_square_error_percent", report.leave_one_out_square_error_percent},
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
