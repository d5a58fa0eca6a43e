#pragma once

#include "pipeline/calibration/calibration.hpp"
#include "pipeline/pattern/sequence.hpp"

#include <filesystem>
#include <string>

namespace bodyscan {

// A folder that goes with this object.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void write_text(const std::filesystem::path& path, const std::string& text);
std::string read_text(const std::filesystem::path& path);

// Replaces the first `from` in a file; the test fails where there is none.
void replace_in(const std::filesystem::path& path, const std::string& from, const std::string& to);

// A camera of 160 x 120 pixels and a projector of 32 x 24, 270 mm below it, that looks at the same wall.
Calibration small_calibration();

// What the camera sees of one pattern on a white wall 1 m away, with light and blur, as an 8-bit PNG file.
void write_photograph(const std::filesystem::path& path, const Pattern& pattern, Size camera);

// A capture of that wall: capture.json, frame_00.png (white), frame_01.png (black), ..., calibration.yml.
void write_small_capture(const std::filesystem::path& folder);

}  // namespace bodyscan
