#include "pipeline/base/instruction_set.hpp"

#include <atomic>

namespace bodyscan {
namespace {

InstructionSet detect() {
  __builtin_cpu_init();
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                  __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  return v4 ? InstructionSet::v4 : v3 ? InstructionSet::v3 : InstructionSet::v2;
}

std::atomic<InstructionSet>& active() {
  static std::atomic<InstructionSet> level = detect();
  return level;
}

}  // namespace

InstructionSet active_instruction_set() {
  return active().load(std::memory_order_relaxed);
}

bool force_instruction_set(InstructionSet level) {
  if (level > detect()) return false;
  active() = level;
  return true;
}

}  // namespace bodyscan
