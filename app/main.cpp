#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "hal/gphoto2/camera_worker.hpp"

int main(int argc, char** argv) {
  if (bodyscan::gphoto2::is_camera_worker(argc, argv)) return bodyscan::gphoto2::run_camera_worker();
  bodyscan::install_signal_handlers();
  const bodyscan::ExitStatus status = bodyscan::run_command_line(argc, argv);
  bodyscan::end_by_remembered_signal();
  return static_cast<int>(status);
}
