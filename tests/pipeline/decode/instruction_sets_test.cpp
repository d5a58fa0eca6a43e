#include "pipeline/base/instruction_set.hpp"
#include "tests/pipeline/decode/synthetic_capture.hpp"

#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

class InstructionSets : public testing::TestWithParam<InstructionSet> {
 protected:
  void TearDown() override { force_instruction_set(before_); }

 private:
  InstructionSet before_ = active_instruction_set();
};

// Projector px: four units in the last place of coordinates about 600, which sums in another order may cost.
constexpr float tolerance = 2.5e-4F;

std::size_t disagreements(const AxisCorrespondence& one, const AxisCorrespondence& other) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < one.coordinate.size().area(); ++i) {
    const float a = one.coordinate.data()[i];
    const float b = other.coordinate.data()[i];
    const bool both_undecided = std::isnan(a) && std::isnan(b);
    const bool same =
        std::abs(a - b) <= tolerance && std::abs(one.sigma.data()[i] - other.sigma.data()[i]) <= tolerance;
    count += !both_undecided && !same;
  }
  return count;
}

// Decodes plainly and at the level, or says why not.
void expect_alike(InstructionSet level, const SequenceOptions& sequence) {
  // A width that no vector divides; noise, shadow, blur and a jump, so that every branch is taken.
  CaptureOptions options{.camera = {243, 101}, .read_noise = 0.003};
  options.sequence = sequence;
  const Scene scene = [plane = plane_scene(options, 20)](int x, int y) {
    Sight sight = plane(x, y);
    sight.scattered = 0.1;
    sight.scattered_row = 380;
    sight.shadow = std::hypot(x - 60, y - 50) < 15;
    if (x > 120) sight.blur_px = 1.5;
    if (y > 60) sight.row += 5;
    return sight;
  };
  const auto frames = capture(scene, options);
  ASSERT_TRUE(force_instruction_set(InstructionSet::v2));
  const Correspondence plain = decode(frames, sequence_of(options), {});
  if (!force_instruction_set(level)) {
    const std::string message = "SKIPPED: this processor lacks x86-64-v" +
                                std::to_string(static_cast<int>(level) + 2) + ", its kernels stay untested";
    std::cerr << message << '\n';
    GTEST_SKIP() << message;
  }
  const Correspondence fast = decode(frames, sequence_of(options), {});
  EXPECT_GT(plain.pixels_decoded, 20000U);
  EXPECT_EQ(fast.pixels_lit, plain.pixels_lit);
  EXPECT_EQ(fast.pixels_decoded, plain.pixels_decoded);
  EXPECT_EQ(disagreements(*fast.rows, *plain.rows), 0U);
  EXPECT_EQ(disagreements(*fast.columns, *plain.columns), 0U);
}

TEST_P(InstructionSets, DecodeGrayCodeAlike) {
  expect_alike(GetParam(), {.columns = true});
}

TEST_P(InstructionSets, DecodePhaseAlike) {
  expect_alike(GetParam(), {.columns = true, .inverses = false, .phase = PhaseCode{}});
}

INSTANTIATE_TEST_SUITE_P(Decoder, InstructionSets, testing::Values(InstructionSet::v3, InstructionSet::v4),
                         [](const auto& tested) { return tested.param == InstructionSet::v3 ? "v3" : "v4"; });

}  // namespace
}  // namespace bodyscan
