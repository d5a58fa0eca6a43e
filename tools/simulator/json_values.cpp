#include "tools/simulator/json_values.hpp"

#include "tools/simulator/image_files.hpp"

#include <string>

namespace bodyscan::simulator {

Json matrix_json(const Eigen::Matrix3d& m) {
  Json rows = Json::array();
  for (int i = 0; i < 3; ++i) rows.push_back(to_json(Eigen::Vector3d(m.row(i))));
  return rows;
}

Json rig_and_camera_json(const RenderOptions& options) {
  return {{"calibration", options.calibration},
          {"rig_scale", options.rig.scale},
          {"rig_projector", {options.rig.projector.width, options.rig.projector.height}},
          {"rig_projector_roll_degrees", options.rig.projector_roll},
          {"light", options.light},
          {"contrast", options.contrast},
          {"ambient", options.ambient},
          {"reflection", options.reflection},
          {"defocus_px", options.defocus},
          {"subsurface", options.subsurface},
          {"subsurface_blur_px", options.subsurface_blur},
          {"uneven_light", options.uneven_light},
          {"rays", options.rays},
          {"lens_blur_px", options.lens_blur},
          {"full_well_electrons", options.full_well},
          {"read_noise_electrons", options.read_noise},
          {"seed", options.seed},
          {"frame_format", options.format == FrameFormat::jpeg ? "jpeg" : "png"},
          {"jpeg_quality", options.jpeg_quality}};
}

Expected<void> write_json(const std::filesystem::path& path, const Json& json) {
  const std::string text = json.dump(2) + "\n";
  return write_bytes(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace bodyscan::simulator
