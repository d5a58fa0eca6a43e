#pragma once

#include "pipeline/base/error.hpp"

#include <string>
#include <string_view>

namespace bodyscan {

// How far a long command is, as one line of standard error that is written over and over; silent unless
// standard error is a terminal.
class Progress {
 public:
  Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();  // clears the line

  void show(std::string_view step);
  void show(std::string_view step, int done, int of);

 private:
  bool terminal_;
  bool shown_ = false;
};

// "bodyscan: MESSAGE" on standard error.
void print_error(std::string_view message);

// Writes a command's result to standard output, whole, and fails where that cannot be done (a full disk, a
// closed pipe).
Expected<void> print_result(const std::string& text);

}  // namespace bodyscan
