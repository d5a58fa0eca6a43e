#include "app/command_line.hpp"
#include "app/console.hpp"
#include "hal/drm/drm_master.hpp"
#include "hal/gphoto2/gphoto2_camera.hpp"

#include <string>

#include <CLI/CLI.hpp>

namespace bodyscan {
namespace {

std::string cameras_text() {
  const auto cameras = gphoto2::list_cameras();
  if (!cameras) return "cameras: " + cameras.error().message + "\n";
  if (cameras->empty()) return "cameras: none found on USB\n";
  std::string text = "cameras:\n";
  for (const auto& [model, port] : *cameras) {
    text += "  ";
    text += model;
    text += " at ";
    text += port;
    text += "\n";
  }
  return text;
}

std::string modes_text(const ProjectorOutput& output) {
  std::string text;
  for (const DisplayMode& mode : output.modes) text += (text.empty() ? "" : ", ") + describe(mode);
  return text;
}

std::string outputs_text() {
  const auto outputs = list_outputs();
  if (!outputs) return "outputs: " + outputs.error().message + "\n";
  if (outputs->empty()) return "outputs: none\n";
  std::string text = "outputs:\n";
  for (const ProjectorOutput& output : *outputs)
    text += "  " + output.connector + ": " +
            (output.modes.empty() ? "nothing plugged in" : "'" + output.edid + "', " + modes_text(output)) +
            "\n";
  return text;
}

}  // namespace

void add_rig_command(CLI::App& app, Action& action) {
  CLI::App& rig = *app.add_subcommand("rig", "Cameras and projectors of a station.");
  rig.require_subcommand(1);
  CLI::App& list = *rig.add_subcommand(
      "list", "List the cameras on USB and the display outputs, as a rig file names them.");
  list.callback([&action] { action = [] { return print_result(cameras_text() + outputs_text()); }; });
}

}  // namespace bodyscan
