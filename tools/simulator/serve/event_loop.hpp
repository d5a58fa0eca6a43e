#pragma once

#include "tools/simulator/serve/moment.hpp"

#include <functional>
#include <map>
#include <optional>
#include <vector>

namespace bodyscan::simulator {

// Waits for descriptors and for time to pass, on one thread.
class EventLoop {
 public:
  // poll(2)'s event bits.
  using Ready = std::function<void(short events)>;
  // Calls `ready` while any of `events` (or an error) holds for the descriptor; replaces what was there. A
  // descriptor is taken out before it is closed.
  void watch(int fd, short events, Ready ready);
  void unwatch(int fd);

  // Calls `advance` after every wait and, at the latest, when `due` tells.
  void add_timer(std::function<std::optional<Moment>()> due, std::function<void(Moment)> advance);

  void run();
  void stop() { running_ = false; }

 private:
  struct Watch {
    short events;
    Ready ready;
  };
  struct Timer {
    std::function<std::optional<Moment>()> due;
    std::function<void(Moment)> advance;
  };
  void wait();

  std::map<int, Watch> watches_;
  std::vector<Timer> timers_;
  bool running_ = false;
};

}  // namespace bodyscan::simulator
