#include "pipeline/base/parallel.hpp"

#include <atomic>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

// The pool is made at the first use; four threads also where the machine has fewer cores.
const bool four_threads = setenv("BODYSCAN_THREADS", "4", 1) == 0;

TEST(ParallelFor, HasTheThreadsAskedFor) {
  ASSERT_TRUE(four_threads);
  EXPECT_EQ(thread_count(), 4);
}

TEST(ParallelFor, CoversTheRangeOnceInPiecesOfTheGrain) {
  for (const int grain : {1, 3, 7, 1000}) {
    std::vector<std::atomic<int>> visits(101);
    parallel_for(-50, 51, grain, [&](int begin, int end) {
      EXPECT_LE(end - begin, grain);
      EXPECT_LT(begin, end);
      for (int i = begin; i < end; ++i) ++visits[static_cast<std::size_t>(i + 50)];
    });
    for (const auto& count : visits) EXPECT_EQ(count, 1) << "grain " << grain;
  }
}

TEST(ParallelFor, AnEmptyRangeCallsNothing) {
  parallel_for(5, 5, 1, [](int, int) { FAIL(); });
  parallel_for(5, 4, 1, [](int, int) { FAIL(); });
}

TEST(ParallelFor, SeveralThreadsTakePart) {
  std::atomic<int> arrived = 0;
  // Ends only if all four pieces run at the same time.
  parallel_for(0, 4, 1, [&](int, int) {
    ++arrived;
    while (arrived < 4) std::this_thread::yield();
  });
  EXPECT_EQ(arrived, 4);
}

TEST(ParallelFor, ANestedCallStaysOnItsThread) {
  parallel_for(0, 8, 1, [](int, int) {
    const std::thread::id outer = std::this_thread::get_id();
    int items = 0;
    parallel_for(0, 100, 10, [&](int begin, int end) {
      EXPECT_EQ(std::this_thread::get_id(), outer);
      items += end - begin;
    });
    EXPECT_EQ(items, 100);
  });
}

TEST(ParallelFor, AnExceptionComesOutAfterTheOthersEnded) {
  std::atomic<int> done = 0;
  EXPECT_THROW(parallel_for(0, 20, 1,
                            [&](int begin, int) {
                              if (begin == 3) throw std::runtime_error("three");
                              ++done;
                            }),
               std::runtime_error);
  EXPECT_EQ(done, 19);
  std::atomic<int> later = 0;
  parallel_for(0, 20, 1, [&](int, int) { ++later; });
  EXPECT_EQ(later, 20);
}

}  // namespace
}  // namespace bodyscan
