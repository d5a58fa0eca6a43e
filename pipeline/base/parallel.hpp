#pragma once

#include <functional>

namespace bodyscan {

// Threads that parallel work is spread over, the caller's included (BODYSCAN_THREADS, else one a core).
int thread_count();

// Calls body(begin, end) for consecutive ranges of at most `grain` items that cover [begin, end) once, on the
// process's thread pool; returns when all are done. A nested call runs on the calling thread. The first
// exception thrown by a body is thrown again here, after the other ranges have ended.
void parallel_for(int begin, int end, int grain, const std::function<void(int, int)>& body);

}  // namespace bodyscan
