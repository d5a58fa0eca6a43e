#pragma once

#include "pipeline/base/error.hpp"
#include "tools/simulator/render_options.hpp"

#include <filesystem>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace bodyscan::simulator {

using Json = nlohmann::ordered_json;

inline Json pixel_json(const Eigen::Vector2d& v) {
  return {v.x(), v.y()};
}
inline Json to_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
// Row by row.
Json matrix_json(const Eigen::Matrix3d& m);

// The settings that do not depend on the subject: rig, light, camera, files.
Json rig_and_camera_json(const RenderOptions& options);

Expected<void> write_json(const std::filesystem::path& path, const Json& json);

}  // namespace bodyscan::simulator
