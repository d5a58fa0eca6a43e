// The fast sequence against the thesis's 22 pictures, of the same scene in the same run.
#include "tests/accuracy/simulated_scan.hpp"
#include "tools/bench/scenes.hpp"

#include <iostream>
#include <string>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

constexpr double quarter = 0.25;

class FastSequence : public testing::TestWithParam<std::string> {};

TEST_P(FastSequence, IsNoWorseThanTheThesissSequence) {
  simulator::RenderOptions options = bench_scene(GetParam(), quarter).value().options;
  const Expected<Evaluation> thesis = scan_simulated(options);
  ASSERT_TRUE(thesis) << thesis.error().message;

  options.sequence = fast_sequence;
  const auto sequence = make_sequence(options.rig.projector, options.sequence);
  ASSERT_TRUE(sequence);
  EXPECT_LE(sequence->patterns.size(), 15U);
  const Expected<Evaluation> fast = scan_simulated(options);
  ASSERT_TRUE(fast) << fast.error().message;

  std::cout << GetParam() << ": RMS " << fast->deviation.rms << " mm, thesis " << thesis->deviation.rms
            << "; over 1 mm " << fast->share_wrong << ", thesis " << thesis->share_wrong << "; completeness "
            << fast->coverage.completeness() << ", thesis " << thesis->coverage.completeness() << '\n';
  EXPECT_LE(fast->deviation.rms, thesis->deviation.rms);
  // A few points of a hundred thousand: chance decides on which side of a silhouette they fall.
  EXPECT_LE(fast->share_wrong, thesis->share_wrong + 3e-5);
  EXPECT_GE(fast->coverage.completeness(), thesis->coverage.completeness() - 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Scenes, FastSequence,
                         testing::Values("spheres", "staircase", "skin_head", "skin_forearm", "bumps_skin",
                                         "blur", "dim"),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace bodyscan
