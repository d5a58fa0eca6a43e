#pragma once

#include "hal/replay/capture_folder.hpp"
#include "hal/replay/session_manifest.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace bodyscan {

// A calibration session on disk, opened: every picture that its manifest names is there, all declare the same
// size, and captures have rows and columns of the session's projector. Immutable; all functions may be called
// from any thread. Messages of `open` name pose and file: "pose 4: session/board.jpg: No such file or
// directory".
class CalibrationSession {
 public:
  // `folder` holds session.json, the pictures and the capture folders.
  static Expected<CalibrationSession> open(const std::filesystem::path& folder,
                                           const ImageLimits& limits = {});

  [[nodiscard]] const SessionManifest& manifest() const { return manifest_; }
  [[nodiscard]] Size size() const { return size_; }  // of every picture
  [[nodiscard]] int pose_count() const { return static_cast<int>(manifest_.poses.size()); }

  // Every picture and manifest of a pose.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;

  // The pictures of a pose that is a pair.
  [[nodiscard]] Expected<Luma> load_printed(int pose) const;
  [[nodiscard]] Expected<Luma> load_projected(int pose) const;

  // Of a pose that is a capture.
  [[nodiscard]] const CaptureFolder& capture(int pose) const;

 private:
  CalibrationSession(std::filesystem::path folder, SessionManifest manifest, const ImageLimits& limits)
      : folder_(std::move(folder)), manifest_(std::move(manifest)), limits_(limits) {}
  [[nodiscard]] Expected<void> open_pose(const PoseFiles& pose);
  [[nodiscard]] Expected<void> open_pair(const PoseFiles& pose);
  [[nodiscard]] Expected<void> open_capture(const PoseFiles& pose);
  [[nodiscard]] Expected<void> check_size(const std::filesystem::path& path, Size size) const;
  [[nodiscard]] Expected<void> admit(const std::filesystem::path& path, Size size);
  [[nodiscard]] Expected<Luma> load(const std::string& file) const;
  [[nodiscard]] const PoseFiles& pose_files(int pose) const {
    return manifest_.poses[static_cast<std::size_t>(pose)];
  }

  std::filesystem::path folder_;
  SessionManifest manifest_;
  ImageLimits limits_;
  std::vector<std::optional<CaptureFolder>> captures_;  // a pose each
  Size size_;
  std::filesystem::path first_;  // whose size that is
};

}  // namespace bodyscan
