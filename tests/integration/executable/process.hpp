#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sys/resource.h>

namespace bodyscan {

struct ProcessResult {
  int status = -1;  // exit status; minus the signal's number if one ended the process
  std::string output;
  std::string error;
};

// Runs the bodyscan executable and waits for it; no file that it writes may grow over `file_bytes`.
ProcessResult run_bodyscan(const std::vector<std::string>& arguments, std::optional<rlim_t> file_bytes = {});

}  // namespace bodyscan
