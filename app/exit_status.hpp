#pragma once

#include "pipeline/base/error.hpp"

namespace bodyscan {

// What the program's exit status says.
enum class ExitStatus {
  done = 0,
  usage = 2,    // the command line is wrong
  file = 3,     // an input is missing, damaged or inconsistent, or a result cannot be written
  device = 4,   // a device failed
  store = 5,    // the store refused or failed; nothing was lost
  quality = 6,  // the scan was made but does not reach the quality asked for
};

ExitStatus exit_status_of(ErrorKind kind);

}  // namespace bodyscan
