#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace bodyscan {
namespace {

thread_local bool inside_pool = false;

int wanted_threads() {
  if (const char* text = std::getenv("BODYSCAN_THREADS")) {
    const int count = std::atoi(text);
    if (count >= 1 && count <= 256) return count;
  }
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

struct Job {
  int end;
  int grain;
  const std::function<void(int, int)>* body;
  std::atomic<int> next;
  std::mutex mutex;
  std::exception_ptr failure;

  void work() {
    inside_pool = true;
    for (;;) {
      const int first = next.fetch_add(grain);
      if (first >= end) break;
      try {
        (*body)(first, std::min(first + grain, end));
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
      }
    }
    inside_pool = false;
  }
};

// Workers sleep between jobs; one job runs at a time.
class ThreadPool {
 public:
  explicit ThreadPool(int threads) {
    for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { loop(); });
  }
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  ~ThreadPool() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    wake_.notify_all();
  }

  [[nodiscard]] int threads() const { return static_cast<int>(workers_.size()) + 1; }

  void run(Job& job) {
    const std::lock_guard one_job(running_);
    {
      const std::lock_guard lock(mutex_);
      job_ = &job;
      busy_ = static_cast<int>(workers_.size());
      ++generation_;
    }
    wake_.notify_all();
    job.work();
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
  }

 private:
  void loop() {
    unsigned long seen = 0;
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [&] { return stop_ || generation_ != seen; });
      if (stop_) return;
      seen = generation_;
      Job* job = job_;
      lock.unlock();
      job->work();
      lock.lock();
      if (--busy_ == 0) done_.notify_one();
    }
  }

  std::mutex running_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable done_;
  Job* job_ = nullptr;
  unsigned long generation_ = 0;
  int busy_ = 0;
  bool stop_ = false;
  std::vector<std::jthread> workers_;  // last: joined before the rest goes
};

ThreadPool& pool() {
  static ThreadPool instance(wanted_threads());
  return instance;
}

}  // namespace

int thread_count() {
  return pool().threads();
}

void parallel_for(int begin, int end, int grain, const std::function<void(int, int)>& body) {
  if (begin >= end) return;
  grain = std::max(1, grain);
  if (inside_pool || end - begin <= grain || thread_count() == 1) {
    for (int first = begin; first < end; first += grain) body(first, std::min(first + grain, end));
    return;
  }
  Job job{.end = end, .grain = grain, .body = &body, .next = begin, .mutex = {}, .failure = {}};
  pool().run(job);
  if (job.failure) std::rethrow_exception(job.failure);
}

}  // namespace bodyscan
