#pragma once

#include "pipeline/base/error.hpp"

namespace bodyscan {

// From now on a first interrupt, hang-up or termination signal is remembered instead of ending the process,
// so that temporary files go before it does; a second one ends it. Broken pipes and files over the size limit
// become errors of the write that met them.
void install_signal_handlers();

// An error once a signal has been remembered; long work asks between its steps.
Expected<void> check_interrupt();

// Ends the process by the remembered signal, so that its parent sees that signal; returns if there is none.
void end_by_remembered_signal();

}  // namespace bodyscan
