#include "app/scan/light_guard.hpp"

#include "hal/clock.hpp"
#include "pipeline/base/number_text.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace bodyscan {
namespace {

using std::chrono::microseconds;

constexpr std::int64_t look_every_us = 10'000;

bool is_black(const GrayImage8& picture) {
  return std::ranges::all_of(picture.pixels(), [](std::uint8_t value) { return value == 0; });
}

}  // namespace

LightGuard::LightGuard(Projector& projector, double max_light_s, std::function<Expected<void>()> stop)
    : projector_(projector),
      max_light_s_(max_light_s),
      stop_(std::move(stop)),
      watcher_([this] { watch(); }) {}

LightGuard::~LightGuard() {
  ending_ = true;
  watcher_.join();
  projector_.close();
}

void LightGuard::watch() {
  while (!ending_) {
    const Expected<void> going_on = stop_();
    {
      const std::lock_guard lock(mutex_);
      if (!stopped_ && !going_on) stopped_ = going_on.error();
      if (!stopped_ && light_s_locked() > max_light_s_)
        stopped_ = Error{ErrorKind::quality, "the projector has shone for " + fixed_text(max_light_s_, 0) +
                                                 " s, as long as one scan may: the scan took too long"};
      if (stopped_ && lit_since_us_ != 0) {
        // Where this fails the projector is gone, and dark.
        const Expected<void> dark = go_dark();
        static_cast<void>(dark);
      }
    }
    std::this_thread::sleep_for(microseconds(look_every_us));
  }
}

double LightGuard::light_s_locked() const {
  const std::int64_t now = lit_since_us_ == 0 ? 0 : monotonic_us() - lit_since_us_;
  return static_cast<double>(light_us_ + now) * 1e-6;
}

double LightGuard::light_s() {
  const std::lock_guard lock(mutex_);
  return light_s_locked();
}

Expected<void> LightGuard::go_dark() {
  light_us_ += lit_since_us_ == 0 ? 0 : monotonic_us() - lit_since_us_;
  lit_since_us_ = 0;
  return projector_.show(GrayImage8(projector_.mode().size, 0)).map([](std::int64_t) {});
}

Expected<void> LightGuard::open() {
  const std::lock_guard lock(mutex_);
  light_us_ += lit_since_us_ == 0 ? 0 : monotonic_us() - lit_since_us_;
  lit_since_us_ = 0;
  if (stopped_) return tl::unexpected(*stopped_);
  return projector_.open();
}

Expected<std::int64_t> LightGuard::show(const GrayImage8& picture) {
  const bool black = is_black(picture);
  const std::lock_guard lock(mutex_);
  if (stopped_) return tl::unexpected(*stopped_);
  if (black) {
    if (const Expected<void> dark = go_dark(); !dark) return tl::unexpected(dark.error());
    return monotonic_us();
  }
  if (lit_since_us_ == 0) lit_since_us_ = monotonic_us();
  return projector_.show(picture);
}

Expected<void> LightGuard::darken() {
  const std::lock_guard lock(mutex_);
  return go_dark();
}

Expected<void> LightGuard::check() {
  const std::lock_guard lock(mutex_);
  if (stopped_) return tl::unexpected(*stopped_);
  return {};
}

Expected<void> LightGuard::wait_until(std::int64_t time_us) {
  for (;;) {
    if (Expected<void> going_on = check(); !going_on) return going_on;
    const std::int64_t left = time_us - monotonic_us();
    if (left <= 0) return {};
    std::this_thread::sleep_for(microseconds(std::min(left, look_every_us)));
  }
}

}  // namespace bodyscan
