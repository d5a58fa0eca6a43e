#include "app/exit_status.hpp"

namespace bodyscan {

ExitStatus exit_status_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::usage:
      return ExitStatus::usage;
    case ErrorKind::input:
    case ErrorKind::output:
      return ExitStatus::file;
    case ErrorKind::device:
      return ExitStatus::device;
    case ErrorKind::store:
      return ExitStatus::store;
    case ErrorKind::quality:
      return ExitStatus::quality;
  }
  return ExitStatus::file;
}

}  // namespace bodyscan
