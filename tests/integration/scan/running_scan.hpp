#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace bodyscan {

struct ScanEnd {
  int status = -1;    // exit status; minus the signal's number if one ended the process
  std::string error;  // standard error
  double seconds = 0;
};

// A program as a child process that cannot outlive the object or, as a failure of the test, its time limit.
class RunningScan {
 public:
  // Standard error goes to the file, standard output nowhere.
  RunningScan(std::vector<std::string> words, std::filesystem::path error);
  RunningScan(const RunningScan&) = delete;
  RunningScan& operator=(const RunningScan&) = delete;
  ~RunningScan();

  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] bool running();
  // The camera worker, once there is one.
  [[nodiscard]] std::optional<pid_t> worker() const;
  // Waits for its end, after which none of its processes may be left.
  ScanEnd end(std::chrono::milliseconds limit);

 private:
  [[nodiscard]] bool left_behind() const;

  std::filesystem::path error_;
  std::string mark_;  // in the environment of the process and of all that it starts
  std::chrono::steady_clock::time_point start_;
  pid_t pid_ = -1;
  std::optional<int> status_;
};

// Runs a program to its end, which must be 0.
void run_program(std::vector<std::string> words);

}  // namespace bodyscan
