#pragma once

#include "hal/camera.hpp"
#include "pipeline/base/error.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace bodyscan {

enum class CameraBackend { gphoto2, replay };
enum class ProjectorBackend { drm, virtual_socket };
enum class PatternChoice { rows, columns, both, fast };

struct CameraConfig {
  CameraBackend backend = CameraBackend::gphoto2;
  std::string port;              // gphoto2: libgphoto2's name of it; empty: the first camera found
  std::filesystem::path folder;  // replay: the capture folder
  CameraSettings settings;
};

struct ProjectorConfig {
  ProjectorBackend backend = ProjectorBackend::drm;
  std::string card;              // drm: "/dev/dri/card0"; empty: the first with displays
  std::string connector;         // drm: "HDMI-A-1"; empty: the only one that fits
  std::filesystem::path socket;  // virtual
  std::string edid;              // empty: any
  double refresh_hz = 60;
  double settle_ms = 150;  // from the page flip until the picture is on the wall
};

struct ScanConfig {
  PatternChoice patterns = PatternChoice::rows;
  int attempts = 3;          // of one shot, until the scan is given up
  double max_motion_mm = 1;  // of the patient during the scan
  double max_light_s = 60;   // that the projector may shine on the patient in one scan
};

// rig.toml: what a station consists of.
struct Rig {
  std::filesystem::path calibration;
  CameraConfig camera;
  ProjectorConfig projector;
  ScanConfig scan;
};

constexpr std::size_t max_rig_bytes = std::size_t{1} << 16;

// `name` stands in front of the message, which names every problem, one a line: unknown keys, missing ones,
// values of the wrong type or out of range. Relative paths start at `folder`.
Expected<Rig> parse_rig(std::string_view text, const std::string& name, const std::filesystem::path& folder);

// The file; relative paths start at its folder.
Expected<Rig> read_rig(const std::filesystem::path& path);

}  // namespace bodyscan
