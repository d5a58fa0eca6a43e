#pragma once

namespace bodyscan {

// The x86-64 levels of the psABI that hot loops are compiled for; v2 is the baseline of the whole program.
enum class InstructionSet { v2, v3, v4 };

// The best level this processor has, or the one a test asked for.
InstructionSet active_instruction_set();

// Runs later kernels at `level` (tests only); false, and no change, if the processor lacks it.
bool force_instruction_set(InstructionSet level);

// A kernel is a struct with a static, always-inline `run`. It is compiled once a level, inlined whole, so its
// code must call only functions that are always inlined too.
#define BODYSCAN_KERNEL [[gnu::always_inline]] static inline

// Before a kernel's loop: its buffers do not overlap, so the loop may be vectorised without asking.
// BODYSCAN_UNROLL, before a short loop inside it, is needed for that.
#ifdef __clang__
#define BODYSCAN_VECTORIZE _Pragma("clang loop vectorize(enable)")
#define BODYSCAN_UNROLL _Pragma("clang loop unroll(full)")
#else
#define BODYSCAN_VECTORIZE _Pragma("GCC ivdep")
#define BODYSCAN_UNROLL _Pragma("GCC unroll 8")
#endif

namespace detail {

template <class Kernel, class... Args>
void run_v2(Args... args) {
  Kernel::run(args...);
}
template <class Kernel, class... Args>
[[gnu::target("avx2,fma,bmi,bmi2,f16c,lzcnt,movbe")]] void run_v3(Args... args) {
  Kernel::run(args...);
}
template <class Kernel, class... Args>
[[gnu::target("avx2,fma,bmi,bmi2,f16c,lzcnt,movbe,avx512f,avx512bw,avx512cd,avx512dq,avx512vl")]] void run_v4(
    Args... args) {
  Kernel::run(args...);
}

}  // namespace detail

template <class Kernel, class... Args>
void run_kernel(Args... args) {
  switch (active_instruction_set()) {
    case InstructionSet::v4:
      return detail::run_v4<Kernel>(args...);
    case InstructionSet::v3:
      return detail::run_v3<Kernel>(args...);
    case InstructionSet::v2:
      return detail::run_v2<Kernel>(args...);
  }
}

}  // namespace bodyscan
