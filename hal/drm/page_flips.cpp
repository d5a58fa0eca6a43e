#include "hal/drm/page_flips.hpp"

#include "hal/clock.hpp"

#include <algorithm>
#include <cerrno>

#include <poll.h>
#include <xf86drm.h>

namespace bodyscan {

void PageFlips::on_flip(int /*fd*/, unsigned /*sequence*/, unsigned seconds, unsigned microseconds,
                        unsigned crtc, void* flips) {
  static_cast<PageFlips*>(flips)->times_us_[crtc] = std::int64_t{seconds} * 1'000'000 + microseconds;
}

PageFlips::Arrival PageFlips::read_events(std::int64_t until_us) {
  const std::int64_t left_ms = (std::max<std::int64_t>(until_us - monotonic_us(), 0) + 999) / 1000;
  pollfd waiting{device_.fd(), POLLIN, 0};
  const int ready = poll(&waiting, 1, static_cast<int>(left_ms));
  if (ready < 0) return errno == EINTR ? Arrival::event : Arrival::failure;
  if (ready == 0) return Arrival::nothing;
  if ((waiting.revents & POLLIN) == 0) return Arrival::failure;
  drmEventContext context{};
  context.version = 3;
  context.page_flip_handler2 = on_flip;
  return drmHandleEvent(device_.fd(), &context) == 0 ? Arrival::event : Arrival::failure;
}

void PageFlips::expect(std::uint32_t crtc) {
  while (read_events(0) == Arrival::event) continue;
  times_us_.erase(crtc);
}

Expected<std::int64_t> PageFlips::wait(std::uint32_t crtc, std::int64_t until_us) {
  for (;;) {
    if (const auto flip = times_us_.find(crtc); flip != times_us_.end()) return flip->second;
    const Arrival arrival = read_events(until_us);
    if (arrival == Arrival::nothing) return device_error("the picture was not shown in time");
    if (arrival == Arrival::failure) return device_error(device_.path() + ": the graphics card is gone");
  }
}

}  // namespace bodyscan
