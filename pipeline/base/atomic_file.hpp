#pragma once

#include "pipeline/base/error.hpp"

#include <filesystem>
#include <string_view>

namespace bodyscan {

// What a committed file outlives. A model can be computed again and is large, so it need not wait for the
// disk; what cannot be made again (a calibration) should.
enum class Durability {
  process,    // complete or absent whatever happens to this process
  power_cut,  // the same after a power cut: waits until file and folder are on the disk
};

// An output file that appears under its name only when it is complete: written under a temporary name in the
// same folder, renamed by `commit`, removed by the destructor otherwise. Symbolic links are followed. An
// existing device or pipe (/dev/stdout) is written in place. Errors are of kind `output` and name the file
// and the system's reason; after one, the file can only be destroyed.
class AtomicFile {
 public:
  [[nodiscard]] static Expected<AtomicFile> create(const std::filesystem::path& path);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  ~AtomicFile();

  // Appends all of `bytes`; unbuffered, so callers hand over large pieces.
  [[nodiscard]] Expected<void> write(std::string_view bytes);
  // Closes the file and gives it its name, replacing a file of that name. Call it once, last.
  [[nodiscard]] Expected<void> commit(Durability durability);

 private:
  AtomicFile(int descriptor, std::filesystem::path path, std::filesystem::path temporary);
  void discard() noexcept;
  [[nodiscard]] tl::unexpected<Error> failure(const char* action, int code) const;

  int descriptor_ = -1;
  std::filesystem::path path_;
  std::filesystem::path temporary_;  // empty: written in place
};

}  // namespace bodyscan
