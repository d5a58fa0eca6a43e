#include "pipeline/decode/decoder.hpp"
#include "tests/pipeline/decode/synthetic_capture.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

namespace bodyscan {
namespace {

std::size_t heap_in_use() {
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

// Heap growth over the frames after the first `settled`, in bytes, while no axis is complete.
std::ptrdiff_t growth(const CaptureOptions& options, std::size_t settled, std::size_t last) {
  auto decoder = Decoder::create(sequence_of(options));
  std::size_t count = 0;
  std::size_t before = 0;
  for (const Pattern& pattern : sequence_of(options).patterns) {
    const bool lit = pattern.kind != PatternKind::black && !pattern.inverted;
    const Frame frame{pattern, GrayImage8(options.camera, static_cast<std::uint8_t>(lit ? 200 : 20))};
    EXPECT_TRUE(decoder->consume(frame).has_value());
    if (++count == settled) before = heap_in_use();
    if (count == last) break;
  }
  return static_cast<std::ptrdiff_t>(heap_in_use()) - static_cast<std::ptrdiff_t>(before);
}

TEST(DecoderMemory, DoesNotGrowWithTheFrames) {
  if (heap_in_use() == 0)
    GTEST_SKIP() << "SKIPPED: this allocator (a sanitizer's) does not say what is in use";
  CaptureOptions options{.camera = {640, 480}, .projector = {32768, 32768}};
  const auto little = static_cast<std::ptrdiff_t>(options.camera.area()) / 4;
  // White, black and the two coarsest bits, which leave samples, then 26 more.
  EXPECT_LT(growth(options, 6, 32), little);
  // White, black and the first step, then the others, and the 12 bits but the last.
  options.sequence = fast_sequence;
  options.sequence.phase = PhaseCode{.period_px = 16, .steps = 16, .finest_bit = 2};
  EXPECT_LT(growth(options, 3, 17), little);
  EXPECT_LT(growth(options, 3, 30), little);
}

}  // namespace
}  // namespace bodyscan
