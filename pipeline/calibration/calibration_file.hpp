#pragma once

#include "pipeline/base/error.hpp"
#include "pipeline/geometry/calibration.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace bodyscan {

constexpr std::size_t max_calibration_bytes = std::size_t{1} << 20;

// Whether the values describe a camera and a projector: finite numbers, sizes and focal lengths above zero, a
// rotation (orthonormal to 1e-5, right-handed) and a baseline. Messages start with the file format's key:
// "rotation: not a rotation".
Expected<void> check_calibration(const Calibration& calibration);

// The text of a calibration file (OpenCV FileStorage YAML), checked. Keys that are not known are ignored.
// `name` stands in front of messages: "calibration.yml: camera_matrix: not finite".
Expected<Calibration> parse_calibration(std::string_view text, const std::string& name);

Expected<Calibration> read_calibration(const std::filesystem::path& path);

// Optional keys of the file.
struct CalibrationNotes {
  std::optional<std::string> calibrated_at;  // ISO 8601, UTC
  std::optional<double> camera_rms_px;
  std::optional<double> projector_rms_px;
  std::optional<double> stereo_rms_px;  // both together
};

// How well a calibration file says that its calibration fits; what it does not say is empty.
Expected<CalibrationNotes> read_calibration_notes(const std::filesystem::path& path);

// The file's content. A calibration that check_calibration rejects is an error of kind `output`. Numbers read
// back equal.
Expected<std::string> calibration_text(const Calibration& calibration, const CalibrationNotes& notes = {});

// The file is complete or not there, even after a power cut.
Expected<void> write_calibration(const Calibration& calibration, const std::filesystem::path& path);

}  // namespace bodyscan
