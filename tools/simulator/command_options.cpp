#include "tools/simulator/command_options.hpp"

#include "tools/simulator/subjects.hpp"

#include <charconv>
#include <vector>

#include <CLI/CLI.hpp>

namespace bodyscan::simulator {
namespace {

// "WIDTHxHEIGHT"; zero sides if it is not that.
Size to_size(const std::string& text) {
  Size size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  if (width.ec != std::errc{} || width.ptr == end || *width.ptr != 'x') return {};
  const auto height = std::from_chars(width.ptr + 1, end, size.height);
  return height.ec == std::errc{} && height.ptr == end ? size : Size{};
}

}  // namespace

void add_subject_options(CLI::App& command, RenderOptions& options) {
  command
      .add_option("--subject", options.subject, "FILE.obj or builtin:NAME (" + builtin_subject_names() + ")")
      ->required();
  command
      .add_option("--material", options.material, "own (as the subject has it), matt (albedo 0.82) or skin")
      ->capture_default_str();
  command.add_option("--scale-subject", options.subject_scale, "mm a unit of the subject")
      ->capture_default_str();
  command
      .add_option_function<std::vector<double>>(
          "--pose",
          [&options](const std::vector<double>& pose) {
            options.pose_rotation = {pose[0], pose[1], pose[2]};
            options.pose_translation = {pose[3], pose[4], pose[5]};
          },
          "rotation vector in degrees about the subject's middle, then mm off 1.05 m before the "
          "camera: RX,RY,RZ,X,Y,Z")
      ->delimiter(',')
      ->expected(6);
  command.add_option("--detail", options.detail, "longest triangle side of built-in body parts, mm")
      ->capture_default_str();
}

void add_rig_options(CLI::App& command, RigOptions& rig, const std::string& projector_size) {
  command.add_option("--scale", rig.scale, "camera pixels of a built-in rig over the full 4288 x 2848")
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          projector_size, [&rig](const std::string& text) { rig.projector = to_size(text); },
          "projector size of a built-in rig")
      ->default_str(std::to_string(rig.projector.width) + "x" + std::to_string(rig.projector.height));
  command
      .add_option("--projector-roll", rig.projector_roll,
                  "degrees about the projector's axis, of a built-in rig")
      ->capture_default_str();
}

void add_light_options(CLI::App& command, RenderOptions& options) {
  command
      .add_option("--light", options.light, "projector light; 1: white matt at 1.05 m is 75 % of full scale")
      ->capture_default_str();
  command.add_option("--contrast", options.contrast, "projector white over black")->capture_default_str();
  command.add_option("--ambient", options.ambient, "room light, of full scale off a white matt surface")
      ->capture_default_str();
  command.add_option("--reflection", options.reflection, "inter-reflected share of a pattern's mean light")
      ->capture_default_str();
  command.add_option("--defocus", options.defocus, "projector blur, standard deviation in projector px")
      ->capture_default_str();
  command
      .add_option(
          "--uneven-light", options.uneven_light,
          "share of the projector's light lost in its picture's last corner, falling linearly from the first")
      ->capture_default_str();
  command
      .add_option(
          "--subsurface", options.subsurface,
          "share of green light scattered under the surface (red 1.3, blue 0.75 times); negative: 0.5 for "
          "skin, else 0")
      ->capture_default_str();
  command
      .add_option("--subsurface-blur", options.subsurface_blur,
                  "further blur of the scattered light, projector px")
      ->capture_default_str();
}

void add_sensor_options(CLI::App& command, RenderOptions& options) {
  command.add_option("--rays", options.rays, "rays a side of a pixel")->capture_default_str();
  command.add_option("--lens-blur", options.lens_blur, "camera blur, standard deviation in camera px")
      ->capture_default_str();
  command.add_option("--full-well", options.full_well, "electrons at full scale; 0: no noise")
      ->capture_default_str();
  command.add_option("--read-noise", options.read_noise, "electrons")->capture_default_str();
  command.add_option("--seed", options.seed, "of the noise")->capture_default_str();
  command.add_option("--jpeg-quality", options.jpeg_quality, "1 to 100")->capture_default_str();
}

void add_camera_options(CLI::App& command, RenderOptions& options) {
  add_sensor_options(command, options);
  command
      .add_option_function<std::string>(
          "--frame-format",
          [&options](const std::string& text) {
            options.format = text == "png" ? FrameFormat::png : FrameFormat::jpeg;
          },
          "jpeg (4:2:2) or png")
      ->check(CLI::IsMember({"jpeg", "png"}))
      ->default_str("jpeg");
}

}  // namespace bodyscan::simulator
