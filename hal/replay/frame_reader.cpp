#include "hal/replay/frame_reader.hpp"

#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace bodyscan {
namespace {

// Frames in memory at once beside the one being consumed: more cores do not decompress further ahead.
constexpr int most_loading = 4;

// One frame in memory, with the error of loading it.
struct Slot {
  Frame frame;
  std::vector<std::byte> file;
  Expected<void> loaded;
};

// What the threads share. Each takes the most urgent work there is: the next frame in order if it is loaded
// and nobody consumes, else loading the first frame that nobody loads, else waiting.
class FrameReader {
 public:
  FrameReader(const CaptureFolder& capture, const std::function<Expected<void>(const Frame&)>& consume)
      : capture_(capture), consume_(consume) {
    for (int i = 0; i < std::min(thread_count(), most_loading) + 1; ++i)
      free_.push_back(std::make_unique<Slot>());
  }

  void work() try {
    std::unique_lock lock(mutex_);
    while (!stopped_ && next_consumed_ < capture_.frame_count()) {
      if (!consuming_ && loaded_.contains(next_consumed_)) {
        consume_next(lock);
      } else if (!free_.empty() && next_loaded_ < capture_.frame_count()) {
        load_next(lock);
      } else {
        changed_.wait(lock);
      }
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
    throw;
  }

  [[nodiscard]] Expected<void> result() const { return result_; }

 private:
  void load_next(std::unique_lock<std::mutex>& lock) {
    const int index = next_loaded_++;
    std::unique_ptr<Slot> slot = std::move(free_.back());
    free_.pop_back();
    lock.unlock();
    slot->loaded = capture_.load_into(index, slot->frame, slot->file);
    lock.lock();
    loaded_.emplace(index, std::move(slot));
    changed_.notify_all();
  }

  void consume_next(std::unique_lock<std::mutex>& lock) {
    std::unique_ptr<Slot> slot = std::move(loaded_.extract(next_consumed_).mapped());
    consuming_ = true;
    lock.unlock();
    Expected<void> consumed = slot->loaded.and_then([&] { return consume_(slot->frame); });
    lock.lock();
    consuming_ = false;
    ++next_consumed_;
    if (!consumed) {
      stopped_ = true;
      result_ = std::move(consumed);
    }
    free_.push_back(std::move(slot));
    changed_.notify_all();
  }

  const CaptureFolder& capture_;
  const std::function<Expected<void>(const Frame&)>& consume_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::unique_ptr<Slot>> free_;
  std::map<int, std::unique_ptr<Slot>> loaded_;
  int next_loaded_ = 0;
  int next_consumed_ = 0;
  bool consuming_ = false;
  bool stopped_ = false;
  Expected<void> result_;
};

}  // namespace

Expected<void> for_each_frame(const CaptureFolder& capture,
                              const std::function<Expected<void>(const Frame&)>& consume) {
  FrameReader reader(capture, consume);
  parallel_for(0, thread_count(), 1, [&](int, int) { reader.work(); });
  return reader.result();
}

}  // namespace bodyscan
