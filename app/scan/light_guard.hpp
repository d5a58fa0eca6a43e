#pragma once

#include "hal/projector.hpp"
#include "pipeline/base/error.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

namespace bodyscan {

// Stands between the scan and the projector's light. A thread of its own darkens the picture within 50 ms
// once `stop` gives an error (an interrupt, the stop button) or once the projector has shone for longer than
// one scan may; from then on nothing but black is shown and every call gives that error. The projector is
// dark when the guard is gone. May be used from one thread.
class LightGuard {
 public:
  LightGuard(Projector& projector, double max_light_s, std::function<Expected<void>()> stop);
  LightGuard(const LightGuard&) = delete;
  LightGuard& operator=(const LightGuard&) = delete;
  ~LightGuard();

  // Opens the projector, dark.
  Expected<void> open();
  // The page flip's time.
  Expected<std::int64_t> show(const GrayImage8& picture);
  Expected<void> darken();
  // Returns at that time (CLOCK_MONOTONIC), or with an error as soon as there is one.
  Expected<void> wait_until(std::int64_t time_us);
  [[nodiscard]] Expected<void> check();

  // How long the projector has shown anything but black, s.
  [[nodiscard]] double light_s();

 private:
  void watch();
  Expected<void> go_dark();
  [[nodiscard]] double light_s_locked() const;

  Projector& projector_;
  double max_light_s_;
  std::function<Expected<void>()> stop_;
  std::mutex mutex_;
  std::optional<Error> stopped_;
  std::int64_t lit_since_us_ = 0;  // 0: dark
  std::int64_t light_us_ = 0;      // before that
  std::atomic<bool> ending_ = false;
  std::thread watcher_;
};

}  // namespace bodyscan
