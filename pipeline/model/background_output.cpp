#include "pipeline/model/background_output.hpp"

#include <string_view>
#include <utility>

namespace bodyscan {

BackgroundOutput::BackgroundOutput(AtomicFile file, std::size_t blocks) : file_(std::move(file)) {
  free_.reserve(blocks);
  for (std::size_t i = 0; i < blocks; ++i) {
    free_.push_back({.bytes = std::make_unique_for_overwrite<char[]>(block_bytes), .size = 0});
  }
  writer_ = std::thread([this] { write_blocks(); });
}

BackgroundOutput::~BackgroundOutput() {
  stop();
}

void BackgroundOutput::stop() {
  if (!writer_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  writer_.join();
}

void BackgroundOutput::write_blocks() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stop_ || !queued_.empty(); });
    if (queued_.empty()) return;
    Block block = std::move(queued_.front());
    queued_.pop_front();
    if (outcome_) {
      lock.unlock();
      Expected<void> written = file_.write(std::string_view(block.bytes.get(), block.size));
      lock.lock();
      if (!written) outcome_ = std::move(written);
    }
    block.size = 0;
    free_.push_back(std::move(block));
    changed_.notify_all();
  }
}

BackgroundOutput::Block BackgroundOutput::take() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !free_.empty(); });
  Block block = std::move(free_.back());
  free_.pop_back();
  return block;
}

Expected<void> BackgroundOutput::put(Block block) {
  const std::lock_guard lock(mutex_);
  queued_.push_back(std::move(block));
  changed_.notify_all();
  return outcome_;
}

Expected<void> BackgroundOutput::finish(Durability durability) {
  stop();
  if (!outcome_) return outcome_;
  return file_.commit(durability);
}

}  // namespace bodyscan
