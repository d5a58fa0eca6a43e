#pragma once

#include "hal/unique_fd.hpp"
#include "pipeline/base/error.hpp"

#include <chrono>
#include <string>
#include <vector>

#include <sys/types.h>

namespace bodyscan::gphoto2 {

// The first argument of the executable in its other role, and where its end of the socket is.
inline constexpr const char* worker_role = "camera-worker";
inline constexpr int worker_socket = 3;

struct WorkerProgram {
  std::string executable = "/proc/self/exe";
  std::vector<std::string> arguments{worker_role};
  // libgphoto2 keeps $HOME/.gphoto/settings; empty: a HOME where nothing can be kept.
  std::string home;
};

// A worker and our end of its socket. The worker has its own process group (a terminal's interrupt is ours to
// deal with), no signal blocked, ignored or handled, and no descriptors but the socket and standard ones;
// only standard error is ours.
class WorkerProcess {
 public:
  WorkerProcess() = default;
  static Expected<WorkerProcess> start(const WorkerProgram& program);
  WorkerProcess(WorkerProcess&& other) noexcept;
  WorkerProcess& operator=(WorkerProcess&& other) noexcept;
  ~WorkerProcess();

  [[nodiscard]] bool running() const { return pid_ > 0; }
  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] int socket() const { return socket_.get(); }
  // Closes the socket, which tells the worker to leave, and kills it where it does not within `patience`.
  void dismiss(std::chrono::milliseconds patience);
  // Kills it unless it ends within `patience`. Answers how it ended by itself ("signal 11"), else nothing.
  std::string kill(std::chrono::milliseconds patience = {});

 private:
  WorkerProcess(pid_t pid, UniqueFd process, UniqueFd socket);

  pid_t pid_ = -1;
  UniqueFd process_;
  UniqueFd socket_;
};

}  // namespace bodyscan::gphoto2
