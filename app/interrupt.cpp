#include "app/interrupt.hpp"

#include <csignal>

namespace bodyscan {
namespace {

volatile std::sig_atomic_t remembered_signal = 0;

void remember(int signal_number) {
  remembered_signal = signal_number;
}

}  // namespace

void install_signal_handlers() {
  struct sigaction action = {};
  action.sa_handler = remember;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal_number, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

Expected<void> check_interrupt() {
  if (remembered_signal != 0) return tl::unexpected(Error{ErrorKind::usage, "interrupted"});
  return {};
}

void end_by_remembered_signal() {
  if (remembered_signal == 0) return;
  std::signal(remembered_signal, SIG_DFL);
  std::raise(remembered_signal);
}

}  // namespace bodyscan
