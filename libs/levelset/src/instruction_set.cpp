#include "shape3d/levelset/instruction_set.hpp"

#include <algorithm>
#include <atomic>

#include "isa.hpp"

namespace shape3d::levelset {
namespace {

InstructionSet detect() {
#if SHAPE3D_LEVELSET_X86
  if (__builtin_cpu_supports("avx2")) return InstructionSet::avx2;
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
      break;
  }
  return "avx2";
}

InstructionSet active_instruction_set() { return current().load(std::memory_order_relaxed); }

InstructionSet use_instruction_set(InstructionSet set) {
  const InstructionSet chosen = std::min(set, detect());
  current().store(chosen, std::memory_order_relaxed);
  return chosen;
}

}  // namespace shape3d::levelset
