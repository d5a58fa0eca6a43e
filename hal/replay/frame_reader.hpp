#pragma once

#include "hal/replay/capture_folder.hpp"

#include <functional>

namespace bodyscan {

// Calls `consume` with every frame in decode order, one call at a time, while the other threads of the
// process's pool decompress the frames that follow: at most one more than there are threads, and at most
// five, are in memory. A call comes from whichever thread is free, so parallel work inside it runs on that
// thread alone. A frame's memory is used again after the call returns. The first error in decode order, of
// the folder or of `consume`, ends it and is returned; an exception of `consume` ends it and comes out here.
Expected<void> for_each_frame(const CaptureFolder& capture,
                              const std::function<Expected<void>(const Frame&)>& consume);

}  // namespace bodyscan
