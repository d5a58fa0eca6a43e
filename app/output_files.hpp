#pragma once

#include "pipeline/base/atomic_file.hpp"
#include "pipeline/base/error.hpp"
#include "pipeline/base/image.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bodyscan {

using OptionalPath = std::optional<std::filesystem::path>;

// Usage error where two of the outputs, or an output and an input, are the same file.
Expected<void> check_distinct(std::span<const std::filesystem::path> outputs,
                              std::span<const std::filesystem::path> inputs);

// An output file that was asked for, or none; the rest of a command need not care which.
class OptionalOutput {
 public:
  // Opened at once, so that a file that cannot be written is known before anything is computed.
  static Expected<OptionalOutput> create(const OptionalPath& path);

  [[nodiscard]] bool wanted() const { return file_.has_value(); }
  Expected<void> write(std::string_view bytes);
  Expected<void> write_png(const ColorImage8& image);
  Expected<void> commit();

 private:
  std::optional<AtomicFile> file_;
};

// A folder for outputs, made with its parents where it is not there; what was made goes with the object while
// nothing lies in it. Error: it cannot be made, or is a file.
class OutputFolder {
 public:
  static Expected<OutputFolder> create(const std::filesystem::path& path);
  OutputFolder(OutputFolder&& other) noexcept = default;
  OutputFolder& operator=(OutputFolder&& other) noexcept = delete;
  ~OutputFolder();

 private:
  OutputFolder() = default;
  std::vector<std::filesystem::path> made_;  // the outermost first; none after a move
};

}  // namespace bodyscan
