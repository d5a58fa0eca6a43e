#pragma once

#include "pipeline/base/error.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace bodyscan {

// What a program that ran to its end took.
struct ProcessUsage {
  int exit_status = 0;  // 128 + signal if it was killed
  double wall_s = 0;
  double cpu_s = 0;           // user and system, all threads
  double peak_memory_mb = 0;  // largest resident set, 10^6 bytes
};

// Runs a program (arguments[0], searched in PATH) without a shell and waits for it. Its standard output goes
// to `output`, or nowhere if that is empty; standard error is shared. An error only if it cannot be started.
Expected<ProcessUsage> run_program(const std::vector<std::string>& arguments,
                                   const std::filesystem::path& output = {});

}  // namespace bodyscan
