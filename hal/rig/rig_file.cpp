#include "hal/rig/rig_file.hpp"

#include "hal/rig/toml_section.hpp"
#include "pipeline/base/read_file.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>
#include <vector>

namespace bodyscan {
namespace {

using Problems = std::vector<std::string>;
using std::filesystem::path;

constexpr std::size_t max_line_bytes = 1000;

constexpr std::array<std::pair<std::string_view, CameraBackend>, 2> camera_backends{
    {{"gphoto2", CameraBackend::gphoto2}, {"replay", CameraBackend::replay}}};
constexpr std::array<std::pair<std::string_view, ProjectorBackend>, 2> projector_backends{
    {{"drm", ProjectorBackend::drm}, {"virtual", ProjectorBackend::virtual_socket}}};
constexpr std::array<std::pair<std::string_view, PatternChoice>, 4> pattern_choices{
    {{"rows", PatternChoice::rows},
     {"columns", PatternChoice::columns},
     {"both", PatternChoice::both},
     {"fast", PatternChoice::fast}}};

CameraConfig read_camera(const toml::table& file, const path& folder, Problems& problems) {
  TomlSection section(file, "camera", problems);
  CameraConfig camera;
  section.require("backend");
  section.read("backend", camera.backend, camera_backends);
  section.read("port", camera.port);
  section.read("folder", camera.folder, folder);
  section.read("exposure_us", camera.settings.exposure_us, 100, 10'000'000);
  section.read("iso", camera.settings.iso, 50, 102'400);
  section.read("aperture", camera.settings.aperture, 0.7, 64);
  section.read("picture", camera.settings.picture, 16384);
  section.reject_others();
  if (section.has("backend") && camera.backend == CameraBackend::replay) section.require("folder");
  return camera;
}

ProjectorConfig read_projector(const toml::table& file, const path& folder, Problems& problems) {
  TomlSection section(file, "projector", problems);
  ProjectorConfig projector;
  section.require("backend");
  section.read("backend", projector.backend, projector_backends);
  section.read("card", projector.card);
  section.read("connector", projector.connector);
  section.read("socket", projector.socket, folder);
  section.read("edid", projector.edid);
  section.read("refresh_hz", projector.refresh_hz, 10, 1000);
  section.read("settle_ms", projector.settle_ms, 0, 5000);
  section.reject_others();
  if (section.has("backend") && projector.backend == ProjectorBackend::virtual_socket)
    section.require("socket");
  return projector;
}

ScanConfig read_scan(const toml::table& file, Problems& problems) {
  TomlSection section(file, "scan", problems);
  ScanConfig scan;
  section.read("patterns", scan.patterns, pattern_choices);
  section.read("attempts", scan.attempts, 1, 20);
  section.read("max_motion_mm", scan.max_motion_mm, 0.01, 1000);
  section.read("max_light_s", scan.max_light_s, 1, 3600);
  section.reject_others();
  return scan;
}

Rig read_sections(const toml::table& file, const path& folder, Problems& problems) {
  TomlSection top(file, "", problems);
  Rig rig;
  top.require("calibration");
  top.read("calibration", rig.calibration, folder);
  for (const char* name : {"camera", "projector"}) top.require(name);
  for (const char* name : {"camera", "projector", "scan"}) top.expect(name);
  top.reject_others();
  if (file.contains("camera")) rig.camera = read_camera(file, folder, problems);
  if (file.contains("projector")) rig.projector = read_projector(file, folder, problems);
  rig.scan = read_scan(file, problems);
  return rig;
}

// A key of thousands of parts, all on one line, would be followed to the end of the stack.
Expected<void> check_lines(std::string_view text, const std::string& name) {
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    if (length > max_line_bytes)
      return input_error(name + ": line " + std::to_string(line) + ": longer than " +
                         std::to_string(max_line_bytes) + " bytes");
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return {};
}

}  // namespace

Expected<Rig> parse_rig(std::string_view text, const std::string& name, const path& folder) {
  if (const Expected<void> lines = check_lines(text, name); !lines) return tl::unexpected(lines.error());
  toml::table file;
  try {
    file = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    std::ostringstream place;
    place << name << ": line " << error.source().begin.line << ": " << error.description();
    return input_error(place.str());
  }
  Problems problems;
  Rig rig = read_sections(file, folder, problems);
  if (problems.empty()) return rig;
  std::string message;
  for (const std::string& problem : problems)
    message.append(message.empty() ? "" : "\n").append(name).append(": ").append(problem);
  return input_error(message);
}

Expected<Rig> read_rig(const std::filesystem::path& path) {
  const Expected<std::vector<std::byte>> bytes = read_file(path, max_rig_bytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return parse_rig(as_text(*bytes), path.string(), path.parent_path());
}

}  // namespace bodyscan
