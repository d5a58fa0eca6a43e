#pragma once

#include <cstdint>
#include <ctime>

namespace bodyscan {

// CLOCK_MONOTONIC in microseconds: the time of page flips and exposures.
inline std::int64_t monotonic_us() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000;
}

}  // namespace bodyscan
