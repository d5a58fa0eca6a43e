#include "app/console.hpp"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include <unistd.h>

namespace bodyscan {

Progress::Progress() : terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::show(std::string_view step) {
  if (!terminal_) return;
  std::fprintf(stderr, "\r\033[K%.*s", static_cast<int>(step.size()), step.data());
  shown_ = true;
}

void Progress::show(std::string_view step, int done, int of) {
  if (terminal_) show(std::string(step) + " " + std::to_string(done) + " of " + std::to_string(of));
}

void print_error(std::string_view message) {
  std::fprintf(stderr, "bodyscan: %.*s\n", static_cast<int>(message.size()), message.data());
}

Expected<void> print_result(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return {};
  return output_error("standard output: cannot write: " + std::generic_category().message(errno));
}

}  // namespace bodyscan
