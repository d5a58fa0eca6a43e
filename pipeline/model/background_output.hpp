#pragma once

#include "pipeline/base/atomic_file.hpp"

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace bodyscan {

// Writes blocks to a file in a thread of its own, in the order in which they were handed over, so that the
// next ones can be formatted meanwhile. The number of blocks bounds the memory; they are used again and
// again.
class BackgroundOutput {
 public:
  static constexpr std::size_t block_bytes = std::size_t{1} << 20;

  struct Block {
    std::unique_ptr<char[]> bytes;  // room for block_bytes
    std::size_t size = 0;
  };

  // `blocks`: how many exist, at least as many as are taken at the same time.
  BackgroundOutput(AtomicFile file, std::size_t blocks);
  BackgroundOutput(const BackgroundOutput&) = delete;
  BackgroundOutput& operator=(const BackgroundOutput&) = delete;
  ~BackgroundOutput();

  // An empty block; waits while all are queued.
  [[nodiscard]] Block take();
  // Queues a block. The error is the first that writing met so far, from then on at every call.
  [[nodiscard]] Expected<void> put(Block block);
  // Waits until all is written, then commits the file. Call it once, last.
  [[nodiscard]] Expected<void> finish(Durability durability);

 private:
  void write_blocks();
  void stop();

  AtomicFile file_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Block> queued_;
  std::vector<Block> free_;
  Expected<void> outcome_;
  bool stop_ = false;
  std::thread writer_;
};

}  // namespace bodyscan
