#pragma once

#include "hal/unique_fd.hpp"
#include "tools/simulator/serve/event_loop.hpp"

#include <functional>
#include <future>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <poll.h>
#include <sys/eventfd.h>

namespace bodyscan::simulator {

// An event loop that runs on a thread of its own until the object ends.
class RunningLoop {
 public:
  RunningLoop() {
    loop_.watch(wake_.get(), POLLIN, [this](short) {
      eventfd_t count = 0;
      eventfd_read(wake_.get(), &count);
      std::vector<std::function<void()>> calls;
      {
        const std::lock_guard lock(mutex_);
        calls.swap(calls_);
      }
      for (const auto& call : calls) call();
    });
  }
  ~RunningLoop() { stop(); }

  EventLoop& loop() { return loop_; }
  // Once everything watches the loop.
  void start() {
    thread_ = std::thread([this] { loop_.run(); });
  }
  void stop() {
    if (!thread_.joinable()) return;
    on_loop([this] { loop_.stop(); });
    thread_.join();
  }
  // Calls on the loop's thread and waits for it.
  void on_loop(const std::function<void()>& call) {
    std::promise<void> done;
    {
      const std::lock_guard lock(mutex_);
      calls_.emplace_back([&] {
        call();
        done.set_value();
      });
    }
    eventfd_write(wake_.get(), 1);
    done.get_future().wait();
  }

 private:
  UniqueFd wake_{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  EventLoop loop_;
  std::mutex mutex_;
  std::vector<std::function<void()>> calls_;
  std::thread thread_;
};

}  // namespace bodyscan::simulator
