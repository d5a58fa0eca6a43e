#include "pipeline/base/instruction_set.hpp"

#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace bodyscan {
namespace {

struct SumOfSquares {
  BODYSCAN_KERNEL void run(const float* values, int count, float* sum) {
    float total = 0;
    for (int i = 0; i < count; ++i) total += values[i] * values[i];
    *sum = total;
  }
};

TEST(InstructionSet, EveryLevelRunsTheKernel) {
  const InstructionSet best = active_instruction_set();
  std::vector<float> values(101);
  std::iota(values.begin(), values.end(), 0.0F);
  for (const InstructionSet level : {InstructionSet::v2, InstructionSet::v3, InstructionSet::v4}) {
    if (level > best) {
      EXPECT_FALSE(force_instruction_set(level));
      EXPECT_EQ(active_instruction_set(), best);
      continue;
    }
    ASSERT_TRUE(force_instruction_set(level));
    EXPECT_EQ(active_instruction_set(), level);
    float sum = 0;
    run_kernel<SumOfSquares>(values.data(), 101, &sum);
    EXPECT_FLOAT_EQ(sum, 338350.0F);
    ASSERT_TRUE(force_instruction_set(best));
  }
}

}  // namespace
}  // namespace bodyscan
