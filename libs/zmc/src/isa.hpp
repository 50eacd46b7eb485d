#pragma once

// Instruction sets chosen at run time. Loops that gain from one are written once, always inlined,
// and wrapped in one function per set; the wrapper carries the target attribute.

#include "shape3d/zmc/instruction_set.hpp"

namespace shape3d::zmc::detail {

using Isa = InstructionSet;

inline Isa active_isa() { return active_instruction_set(); }

}  // namespace shape3d::zmc::detail

#if defined(__x86_64__) && defined(__GNUC__)
#define SHAPE3D_ZMC_X86 1
#define SHAPE3D_ZMC_TARGET_AVX2 __attribute__((target("avx2,bmi,bmi2,popcnt,lzcnt")))
#define SHAPE3D_ZMC_TARGET_AVX512 \
  __attribute__((                 \
      target("avx512f,avx512bw,avx512vl,avx512dq,avx512vpopcntdq,avx2,bmi,bmi2,popcnt,lzcnt")))
#else
#define SHAPE3D_ZMC_X86 0
#define SHAPE3D_ZMC_TARGET_AVX2
#define SHAPE3D_ZMC_TARGET_AVX512
#endif
