#pragma once

#include "hal/replay/capture_manifest.hpp"
#include "pipeline/image/codec.hpp"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace bodyscan {

// A capture on disk, opened: the manifest is complete and every frame's file is there and declares the same
// size. Immutable; all functions may be called from any thread. Messages start with the path of the file they
// are about, as the caller gave it.
class CaptureFolder {
 public:
  // `folder` holds capture.json and the frames.
  static Expected<CaptureFolder> open(const std::filesystem::path& folder, const ImageLimits& limits = {});

  [[nodiscard]] const CaptureManifest& manifest() const { return manifest_; }
  [[nodiscard]] Size size() const { return size_; }  // of every frame
  [[nodiscard]] int frame_count() const { return static_cast<int>(manifest_.frames.size()); }

  // capture.json and the frames.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;

  // Frame `index` (0 to frame_count() - 1) in decode order.
  [[nodiscard]] Expected<Frame> load(int index) const;

  // The same into memory that is used again; `frame` is unspecified after an error.
  [[nodiscard]] Expected<void> load_into(int index, Frame& frame, std::vector<std::byte>& file_buffer) const;

  // The white and the black frame in colour.
  [[nodiscard]] Expected<ColorImage8> load_white_color() const;
  [[nodiscard]] Expected<ColorImage8> load_black_color() const;

 private:
  CaptureFolder(std::filesystem::path folder, CaptureManifest manifest, const ImageLimits& limits)
      : folder_(std::move(folder)), manifest_(std::move(manifest)), limits_(limits) {}
  [[nodiscard]] Expected<ColorImage8> load_color(int index) const;
  [[nodiscard]] std::filesystem::path path_of(int index) const;
  [[nodiscard]] Expected<Size> declared_size(int index) const;
  [[nodiscard]] Expected<void> check_size(int index, Size size) const;

  std::filesystem::path folder_;
  CaptureManifest manifest_;
  ImageLimits limits_;
  Size size_;
};

}  // namespace bodyscan
