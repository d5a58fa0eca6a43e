#pragma once

#include "pipeline/base/error.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace bodyscan {

// `bodyscan-simulator serve`, running: a camera and a projector in a simulated world. Gone with the object.
class ServedWorld {
 public:
  // `arguments` after `serve`, without the projector's socket, which lies in `folder`. Returns once it is
  // ready.
  static Expected<ServedWorld> start(std::vector<std::string> arguments, const std::filesystem::path& folder);
  ServedWorld(ServedWorld&& other) noexcept;
  ServedWorld& operator=(ServedWorld&&) = delete;
  ~ServedWorld();

  [[nodiscard]] const std::string& camera_port() const { return camera_port_; }
  [[nodiscard]] const std::string& projector_socket() const { return projector_socket_; }

 private:
  ServedWorld() = default;

  pid_t pid_ = -1;
  std::string camera_port_;
  std::string projector_socket_;
};

}  // namespace bodyscan
