#include "isa.hpp"

#include <algorithm>
#include <atomic>

namespace shape3d::zmc {
namespace {

InstructionSet detect() {
#if SHAPE3D_ZMC_X86
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
                    __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt");
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") &&
                      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
                      __builtin_cpu_supports("avx512vpopcntdq") &&
                      __builtin_cpu_supports("avx512dq");
  if (avx512) return InstructionSet::avx512;
  if (avx2) return InstructionSet::avx2;
#endif
  return InstructionSet::portable;
}

std::atomic<InstructionSet>& current() {
  static std::atomic<InstructionSet> set{detect()};
  return set;
}

}  // namespace

std::string_view to_string(InstructionSet set) {
  switch (set) {
    case InstructionSet::portable:
      return "portable";
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::avx512:
      break;
  }
  return "avx512";
}

InstructionSet active_instruction_set() { return current().load(std::memory_order_relaxed); }

InstructionSet use_instruction_set(InstructionSet set) {
  const InstructionSet chosen = std::min(set, detect());
  current().store(chosen, std::memory_order_relaxed);
  return chosen;
}

}  // namespace shape3d::zmc
