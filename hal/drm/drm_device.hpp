#pragma once

#include "hal/unique_fd.hpp"
#include "pipeline/base/error.hpp"

#include <string>

namespace bodyscan {

// An open graphics card (/dev/dri/cardN) that can do atomic modesetting. Whoever opens it first drives the
// displays ("DRM master"); the others may look.
class DrmDevice {
 public:
  // Without a path: the first card that has a display connector.
  static Expected<DrmDevice> open(const std::string& path);

  [[nodiscard]] int fd() const { return fd_.get(); }
  [[nodiscard]] const std::string& path() const { return path_; }

  // An error where another program drives the displays.
  [[nodiscard]] Expected<void> become_master() const;

  // With errno's text.
  [[nodiscard]] tl::unexpected<Error> error(const std::string& what) const;

 private:
  DrmDevice(UniqueFd fd, std::string path) : fd_(std::move(fd)), path_(std::move(path)) {}

  static Expected<DrmDevice> open_card(const std::string& path);

  UniqueFd fd_;
  std::string path_;
};

}  // namespace bodyscan
