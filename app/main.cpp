#include "app/command_line.hpp"
#include "app/interrupt.hpp"

int main(int argc, char** argv) {
  bodyscan::install_signal_handlers();
  const bodyscan::ExitStatus status = bodyscan::run_command_line(argc, argv);
  bodyscan::end_by_remembered_signal();
  return static_cast<int>(status);
}
