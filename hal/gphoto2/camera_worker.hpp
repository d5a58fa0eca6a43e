#pragma once

namespace bodyscan::gphoto2 {

// Whether this process was started as a camera worker.
bool is_camera_worker(int argc, const char* const* argv);

// The worker: answers requests on the inherited socket until the other side closes it or ends. Returns the
// exit status.
int run_camera_worker();

}  // namespace bodyscan::gphoto2
