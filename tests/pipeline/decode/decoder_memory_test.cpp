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

// Heap growth over the frames after the first pair of each axis, in bytes.
std::ptrdiff_t growth(const CaptureOptions& options) {
  auto decoder = Decoder::create(sequence_of(options));
  const std::size_t bits = static_cast<std::size_t>(gray_bits(options.projector.height));
  std::size_t count = 0;
  std::size_t before = 0;
  for (const Pattern& pattern : sequence_of(options).patterns) {
    const bool lit =
        pattern.kind == PatternKind::white || (pattern.kind == PatternKind::gray && !pattern.inverted);
    const Frame frame{pattern, GrayImage8(options.camera, static_cast<std::uint8_t>(lit ? 200 : 20))};
    EXPECT_TRUE(decoder->consume(frame).has_value());
    if (++count == 6) before = heap_in_use();  // white, black and the two coarsest bits, which leave samples
    if (count == 2 + 2 * bits) break;
  }
  return static_cast<std::ptrdiff_t>(heap_in_use()) - static_cast<std::ptrdiff_t>(before);
}

TEST(DecoderMemory, DoesNotGrowWithTheFrames) {
  if (heap_in_use() == 0)
    GTEST_SKIP() << "SKIPPED: this allocator (a sanitizer's) does not say what is in use";
  const CaptureOptions options{.camera = {640, 480}, .projector = {32768, 32768}};
  EXPECT_LT(growth(options), static_cast<std::ptrdiff_t>(options.camera.area()) / 4)
      << "bytes over 26 more frames";
}

}  // namespace
}  // namespace bodyscan
