#pragma once

#include <chrono>

namespace bodyscan::simulator {

// CLOCK_MONOTONIC.
using Clock = std::chrono::steady_clock;
using Moment = Clock::time_point;

inline double seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

inline Clock::duration from_seconds(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace bodyscan::simulator
