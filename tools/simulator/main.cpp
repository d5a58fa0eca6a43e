#include "pipeline/calibration/calibration_file.hpp"
#include "tools/simulator/capture_folder.hpp"
#include "tools/simulator/rig.hpp"
#include "tools/simulator/subjects.hpp"

#include <charconv>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace bodyscan::simulator {
namespace {

constexpr int usage_status = 2;
constexpr int input_status = 3;

int fail(const Error& error) {
  std::fprintf(stderr, "bodyscan-simulator: %s\n", error.message.c_str());
  return error.kind == ErrorKind::usage ? usage_status : input_status;
}

// "WIDTHxHEIGHT"; zero sides if it is not that.
Size to_size(const std::string& text) {
  Size size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  if (width.ec != std::errc{} || width.ptr == end || *width.ptr != 'x') return {};
  const auto height = std::from_chars(width.ptr + 1, end, size.height);
  return height.ec == std::errc{} && height.ptr == end ? size : Size{};
}

void add_rig_options(CLI::App& command, RigOptions& rig, std::string& projector) {
  command.add_option("--scale", rig.scale, "camera pixels of a built-in rig over the full 4288 x 2848")
      ->capture_default_str();
  command.add_option("--projector", projector, "projector size of a built-in rig")->capture_default_str();
  command
      .add_option("--projector-roll", rig.projector_roll,
                  "degrees about the projector's axis, of a built-in rig")
      ->capture_default_str();
}

// Values the command line gives as text.
struct RawOptions {
  std::string projector = "1024x768";
  std::vector<double> pose;
  std::vector<double> motion;
  std::string axes = "rows";
  std::string frame_format = "jpeg";
  bool no_inverses = false;
  bool no_mesh = false;
};

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
          "--subsurface", options.subsurface,
          "share of green light scattered under the surface (red 1.3, blue 0.75 times); negative: 0.5 for "
          "skin, else 0")
      ->capture_default_str();
  command
      .add_option("--subsurface-blur", options.subsurface_blur,
                  "further blur of the scattered light, projector px")
      ->capture_default_str();
}

void add_camera_options(CLI::App& command, RenderOptions& options, RawOptions& raw) {
  command.add_option("--rays", options.rays, "rays a side of a pixel")->capture_default_str();
  command.add_option("--full-well", options.full_well, "electrons at full scale; 0: no noise")
      ->capture_default_str();
  command.add_option("--read-noise", options.read_noise, "electrons")->capture_default_str();
  command.add_option("--seed", options.seed, "of the noise")->capture_default_str();
  command.add_option("--frame-format", raw.frame_format, "jpeg (4:2:2) or png")
      ->check(CLI::IsMember({"jpeg", "png"}))
      ->capture_default_str();
  command.add_option("--jpeg-quality", options.jpeg_quality, "1 to 100")->capture_default_str();
  command.add_option("--axes", raw.axes, "stripes along rows, columns or both")
      ->check(CLI::IsMember({"rows", "columns", "both"}))
      ->capture_default_str();
  command.add_flag("--no-inverses", raw.no_inverses, "leave the complement pictures out");
  command.add_flag("--no-mesh", raw.no_mesh, "do not write truth/mesh.obj");
}

void add_subject_options(CLI::App& command, RenderOptions& options, RawOptions& raw) {
  command
      .add_option("--subject", options.subject, "FILE.obj or builtin:NAME (" + builtin_subject_names() + ")")
      ->required();
  command
      .add_option("--material", options.material, "own (as the subject has it), matt (albedo 0.82) or skin")
      ->capture_default_str();
  command.add_option("--scale-subject", options.subject_scale, "mm a unit of the subject")
      ->capture_default_str();
  command
      .add_option("--pose", raw.pose,
                  "rotation vector in degrees about the subject's middle, then mm off 1.05 m before the "
                  "camera: RX,RY,RZ,X,Y,Z")
      ->delimiter(',')
      ->expected(6);
  command
      .add_option("--motion", raw.motion,
                  "mm the subject moves from frame to frame: X,Y,Z (the truth is the first frame's)")
      ->delimiter(',')
      ->expected(3);
  command.add_option("--detail", options.detail, "longest triangle side of built-in body parts, mm")
      ->capture_default_str();
}

int render(RenderOptions options, const RawOptions& raw) {
  options.rig.projector = to_size(raw.projector);
  if (raw.pose.size() == 6) {
    options.pose_rotation = {raw.pose[0], raw.pose[1], raw.pose[2]};
    options.pose_translation = {raw.pose[3], raw.pose[4], raw.pose[5]};
  }
  if (raw.motion.size() == 3) options.motion = {raw.motion[0], raw.motion[1], raw.motion[2]};
  options.sequence = {raw.axes != "columns", raw.axes != "rows", !raw.no_inverses};
  options.format = raw.frame_format == "png" ? FrameFormat::png : FrameFormat::jpeg;
  options.write_mesh = !raw.no_mesh;
  const Expected<Truth> truth = render_capture(options);
  return truth ? 0 : fail(truth.error());
}

int write_rig(RigOptions options, const std::string& projector, const std::string& output) {
  options.projector = to_size(projector);
  const Expected<Calibration> rig = make_rig(options);
  if (!rig) return fail(rig.error());
  const Expected<void> written = write_calibration(*rig, output);
  return written ? 0 : fail(written.error());
}

int run(int argc, char** argv) {
  CLI::App app("Renders what a structured-light scanner's camera would see.");
  app.require_subcommand(1);

  RenderOptions options;
  RawOptions raw;
  CLI::App& render_command = *app.add_subcommand("render", "Render a capture folder and the truth beside it");
  add_subject_options(render_command, options, raw);
  render_command
      .add_option("--calibration", options.calibration, "FILE.yml or builtin:RIG (rows, columns, diagonal)")
      ->required();
  render_command.add_option("--output", options.output, "the capture folder")->required();
  add_rig_options(render_command, options.rig, raw.projector);
  add_light_options(render_command, options);
  add_camera_options(render_command, options, raw);
  render_command.footer(
      "truth/reachable.png is white where all rays of a pixel and its four neighbours meet one smooth piece "
      "of the\n"
      "surface, inside the projector's picture, directly lit, and at most 75 degrees from its normal for "
      "camera and\n"
      "projector.");

  RigOptions rig;
  std::string rig_projector = raw.projector;
  std::string rig_output;
  CLI::App& rig_command = *app.add_subcommand("rig", "Write the calibration of a built-in rig");
  rig_command.add_option("--name", rig.name, "rows, columns or diagonal: where the projector stands")
      ->capture_default_str();
  add_rig_options(rig_command, rig, rig_projector);
  rig_command.add_option("--output", rig_output, "the calibration file")->required();

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : usage_status;
  }
  return render_command.parsed() ? render(std::move(options), raw)
                                 : write_rig(rig, rig_projector, rig_output);
}

}  // namespace
}  // namespace bodyscan::simulator

int main(int argc, char** argv) {
  try {
    return bodyscan::simulator::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bodyscan-simulator: %s\n", error.what());
    return 1;
  }
}
