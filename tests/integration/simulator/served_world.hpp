#pragma once

#include "tests/support/temporary_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace bodyscan {

struct Finished {
  int status = -1;     // exit status; minus the signal's number if one ended the process
  std::string output;  // standard output and error
};

// bodyscan-simulator serve, ended with the object.
class ServedWorld {
 public:
  // Returns once it is ready.
  explicit ServedWorld(const std::vector<std::string>& options);
  ServedWorld(const ServedWorld&) = delete;
  ServedWorld& operator=(const ServedWorld&) = delete;
  ~ServedWorld() { end(); }

  // gphoto2 with this world's port, in a folder and with a HOME of its own.
  Finished gphoto2(const std::vector<std::string>& arguments);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
  [[nodiscard]] std::filesystem::path projector() const { return folder_ / "projector"; }
  [[nodiscard]] const std::string& ready_line() const { return ready_line_; }
  [[nodiscard]] std::string camera() const;  // "ptpip:127.0.0.1:PORT:PORT"
  [[nodiscard]] pid_t pid() const { return pid_; }
  // Ends it by a signal; its exit status and what it printed after its first line.
  Finished end(int signal = 15);

 private:
  TemporaryFolder folder_;
  pid_t pid_ = -1;
  int output_ = -1;
  std::string ready_line_;
};

}  // namespace bodyscan
