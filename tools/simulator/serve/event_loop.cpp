#include "tools/simulator/serve/event_loop.hpp"

#include <algorithm>
#include <ctime>
#include <utility>

#include <poll.h>

namespace bodyscan::simulator {

void EventLoop::watch(int fd, short events, Ready ready) {
  watches_[fd] = {events, std::move(ready)};
}

void EventLoop::unwatch(int fd) {
  watches_.erase(fd);
}

void EventLoop::add_timer(std::function<std::optional<Moment>()> due, std::function<void(Moment)> advance) {
  timers_.push_back({std::move(due), std::move(advance)});
}

void EventLoop::wait() {
  std::optional<Moment> next;
  for (const Timer& timer : timers_) {
    const std::optional<Moment> due = timer.due();
    if (due && (!next || *due < *next)) next = due;
  }
  timespec left{};
  if (next) {
    const auto duration = std::max(Clock::duration::zero(), *next - Clock::now());
    const auto whole = std::chrono::duration_cast<std::chrono::seconds>(duration);
    left.tv_sec = whole.count();
    left.tv_nsec = std::chrono::nanoseconds(duration - whole).count();
  }
  std::vector<pollfd> polled;
  for (const auto& [fd, watch] : watches_) polled.push_back({fd, watch.events, 0});
  if (ppoll(polled.data(), polled.size(), next ? &left : nullptr, nullptr) <= 0) return;
  for (const pollfd& descriptor : polled) {
    if (descriptor.revents == 0) continue;
    const auto found = watches_.find(descriptor.fd);
    if (found == watches_.end()) continue;
    const Ready ready = found->second.ready;  // a copy: it may take itself out
    ready(descriptor.revents);
  }
}

void EventLoop::run() {
  running_ = true;
  while (running_) {
    wait();
    const Moment now = Clock::now();
    for (const Timer& timer : timers_) timer.advance(now);
  }
}

}  // namespace bodyscan::simulator
