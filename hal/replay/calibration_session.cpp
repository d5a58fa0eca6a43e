#include "hal/replay/calibration_session.hpp"

#include "hal/replay/picture_file.hpp"
#include "pipeline/base/read_file.hpp"
#include "pipeline/base/size_text.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace bodyscan {
namespace {

Expected<void> check_axes(const CaptureManifest& capture, const std::string& path) {
  for (const Axis axis : {Axis::row, Axis::column}) {
    const bool found =
        std::any_of(capture.frames.begin(), capture.frames.end(), [&](const ManifestFrame& frame) {
          return frame.pattern.kind == PatternKind::gray && frame.pattern.axis == axis;
        });
    if (!found)
      return input_error(path + ": has no " + (axis == Axis::row ? "row" : "column") +
                         " patterns; a calibration needs rows and columns");
  }
  return {};
}

}  // namespace

Expected<CalibrationSession> CalibrationSession::open(const std::filesystem::path& folder,
                                                      const ImageLimits& limits) {
  const std::filesystem::path manifest_path = folder / "session.json";
  const Expected<std::vector<std::byte>> text = read_file(manifest_path, max_session_bytes);
  if (!text) return tl::unexpected(text.error());
  Expected<SessionManifest> manifest = parse_session(as_text(*text), manifest_path.string());
  if (!manifest) return tl::unexpected(manifest.error());

  CalibrationSession session(folder, std::move(*manifest), limits);
  for (const PoseFiles& pose : session.manifest_.poses) {
    if (Expected<void> opened = session.open_pose(pose); !opened)
      return tl::unexpected(opened.error().within(pose.name));
  }
  return session;
}

Expected<void> CalibrationSession::open_pose(const PoseFiles& pose) {
  captures_.emplace_back();
  return pose.is_pair() ? open_pair(pose) : open_capture(pose);
}

Expected<void> CalibrationSession::open_pair(const PoseFiles& pose) {
  for (const std::string& file : {*pose.printed, *pose.projected}) {
    const std::filesystem::path path = folder_ / file;
    const Expected<Size> size = declared_size(path, limits_);
    if (!size) return tl::unexpected(size.error());
    if (Expected<void> admitted = admit(path, *size); !admitted) return admitted;
  }
  return {};
}

Expected<void> CalibrationSession::open_capture(const PoseFiles& pose) {
  const std::filesystem::path path = folder_ / *pose.capture;
  const std::string manifest_path = (path / "capture.json").string();
  Expected<CaptureFolder> capture = CaptureFolder::open(path, limits_);
  if (!capture) return tl::unexpected(capture.error());
  if (Expected<void> axes = check_axes(capture->manifest(), manifest_path); !axes) return axes;
  if (capture->manifest().projector != manifest_.projector)
    return input_error(manifest_path + ": projector: " + text_of(capture->manifest().projector) +
                       ", while the session's has " + text_of(manifest_.projector));
  if (Expected<void> admitted = admit(path, capture->size()); !admitted) return admitted;
  captures_.back() = std::move(*capture);
  return {};
}

Expected<void> CalibrationSession::admit(const std::filesystem::path& path, Size size) {
  if (first_.empty()) {
    first_ = path;
    size_ = size;
  }
  return check_size(path, size);
}

Expected<void> CalibrationSession::check_size(const std::filesystem::path& path, Size size) const {
  if (size == size_) return {};
  return input_error(path.string() + ": " + text_of(size) + " pixels, while " + first_.string() + " has " +
                     text_of(size_));
}

std::vector<std::filesystem::path> CalibrationSession::files() const {
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < pose_count(); ++i) {
    const PoseFiles& pose = pose_files(i);
    const auto more =
        pose.is_pair() ? std::vector{folder_ / *pose.printed, folder_ / *pose.projected} : capture(i).files();
    files.insert(files.end(), more.begin(), more.end());
  }
  return files;
}

Expected<Luma> CalibrationSession::load_printed(int pose) const {
  return load(*pose_files(pose).printed);
}

Expected<Luma> CalibrationSession::load_projected(int pose) const {
  return load(*pose_files(pose).projected);
}

Expected<Luma> CalibrationSession::load(const std::string& file) const {
  const std::filesystem::path path = folder_ / file;
  Expected<Luma> luma = load_luma(path, limits_);
  if (!luma) return luma;
  if (Expected<void> same = check_size(path, size_of(*luma)); !same) return tl::unexpected(same.error());
  return luma;
}

const CaptureFolder& CalibrationSession::capture(int pose) const {
  return *captures_[static_cast<std::size_t>(pose)];
}

}  // namespace bodyscan
