#include "hal/replay/frame_reader.hpp"

#include "pipeline/base/parallel.hpp"
#include "tests/hal/replay/capture_fixture.hpp"

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <thread>

namespace bodyscan {
namespace {

// Four threads also where the machine has fewer cores.
const bool four_threads = setenv("BODYSCAN_THREADS", "4", 1) == 0;

class FrameReaderTest : public CaptureFixture {
 protected:
  void SetUp() override {
    ASSERT_TRUE(four_threads);
    CaptureFixture::SetUp();
  }
};

TEST_F(FrameReaderTest, FramesComeInOrderOneAtATime) {
  const auto capture = CaptureFolder::open(folder_);
  ASSERT_TRUE(capture);
  for (int repetition = 0; repetition < 50; ++repetition) {
    std::atomic<int> inside = 0;
    int next = 0;
    const auto read = for_each_frame(*capture, [&](const Frame& frame) -> Expected<void> {
      EXPECT_EQ(++inside, 1);
      EXPECT_EQ(frame.pattern, capture->manifest().frames[static_cast<std::size_t>(next)].pattern);
      EXPECT_EQ(std::get<GrayImage8>(frame.luma)(7, 3), value(next));
      ++next;
      if (next % 3 == 0) std::this_thread::yield();
      --inside;
      return {};
    });
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(next, capture->frame_count());
  }
}

TEST_F(FrameReaderTest, AtMostOneFrameMoreThanThreadsIsInMemory) {
  const auto capture = CaptureFolder::open(folder_);
  std::set<const void*> memory;
  const auto read = for_each_frame(*capture, [&](const Frame& frame) -> Expected<void> {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));  // the others run ahead as far as they may
    memory.insert(std::get<GrayImage8>(frame.luma).data());
    return {};
  });
  ASSERT_TRUE(read);
  EXPECT_LE(memory.size(), 5U);
}

// Frame 1 is taken away while frame 0 is consumed: it comes all the same if another thread has it by then.
TEST_F(FrameReaderTest, OtherThreadsLoadWhileOneConsumes) {
  const auto capture = CaptureFolder::open(folder_);
  bool ahead = false;
  for (int attempt = 1; attempt <= 20 && !ahead; ++attempt) {
    const auto read = for_each_frame(*capture, [&](const Frame& frame) -> Expected<void> {
      if (frame.pattern.kind == PatternKind::white) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10 * attempt));
        std::filesystem::remove(folder_ / "frame_1.png");
      }
      return {};
    });
    ahead = read.has_value();
    write_image("frame_1.png", GrayImage8(frame_size, value(1)));
  }
  EXPECT_TRUE(ahead);
}

TEST_F(FrameReaderTest, TheConsumersErrorEndsIt) {
  const auto capture = CaptureFolder::open(folder_);
  int calls = 0;
  const auto read = for_each_frame(*capture, [&](const Frame&) -> Expected<void> {
    if (++calls == 4) return input_error("enough");
    return {};
  });
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, "enough");
  EXPECT_EQ(calls, 4);
}

TEST_F(FrameReaderTest, TheFirstDamagedFrameIsReportedAfterThoseBeforeIt) {
  const auto capture = CaptureFolder::open(folder_);
  std::filesystem::resize_file(folder_ / "frame_5.png", 40);
  std::filesystem::remove(folder_ / "frame_6.png");
  for (int repetition = 0; repetition < 20; ++repetition) {
    int calls = 0;
    const auto read = for_each_frame(*capture, [&](const Frame&) -> Expected<void> {
      ++calls;
      return {};
    });
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().message, path("frame_5.png") + ": damaged PNG: the file ends early");
    EXPECT_EQ(calls, 5);
  }
}

TEST_F(FrameReaderTest, AnExceptionOfTheConsumerComesOut) {
  const auto capture = CaptureFolder::open(folder_);
  const auto consume = [](const Frame& frame) -> Expected<void> {
    if (frame.pattern.kind == PatternKind::black) throw std::runtime_error("black");
    return {};
  };
  EXPECT_THROW((void)for_each_frame(*capture, consume), std::runtime_error);
}

TEST_F(FrameReaderTest, WorksInsideAParallelLoop) {
  const auto capture = CaptureFolder::open(folder_);
  std::atomic<int> calls = 0;
  parallel_for(0, 3, 1, [&](int, int) {
    const auto read = for_each_frame(*capture, [&](const Frame&) -> Expected<void> {
      ++calls;
      return {};
    });
    EXPECT_TRUE(read);
  });
  EXPECT_EQ(calls, 3 * 14);
}

}  // namespace
}  // namespace bodyscan
