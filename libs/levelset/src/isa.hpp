#pragma once

// Instruction sets chosen at run time. Loops that gain from one are written once, always inlined,
// and wrapped in one function per set; the wrapper carries the target attribute.

#include "shape3d/levelset/instruction_set.hpp"

#define SHAPE3D_LEVELSET_INLINE inline __attribute__((always_inline))

#if defined(__x86_64__) && defined(__GNUC__)
#define SHAPE3D_LEVELSET_X86 1
#define SHAPE3D_LEVELSET_TARGET_AVX2 __attribute__((target("avx2")))
/// Calls function_avx2(…) or function_portable(…).
#define SHAPE3D_LEVELSET_DISPATCH(function, ...)                                   \
  (active_instruction_set() == InstructionSet::avx2 ? function##_avx2(__VA_ARGS__) \
                                                    : function##_portable(__VA_ARGS__))
#else
#define SHAPE3D_LEVELSET_X86 0
#define SHAPE3D_LEVELSET_TARGET_AVX2
#define SHAPE3D_LEVELSET_DISPATCH(function, ...) function##_portable(__VA_ARGS__)
#endif
