#pragma once

// Instruction sets chosen at run time. Loops that gain from one are written once, always inlined,
// and wrapped in one function per set; the wrapper carries the target attribute.

namespace shape3d::zmc::detail {

enum class Isa {
  portable,  ///< What the compiler was told to assume.
  avx2,      ///< AVX2, BMI1, BMI2, POPCNT, LZCNT.
  avx512     ///< The same and AVX-512 F, BW, VL, DQ, VPOPCNTDQ.
};

/// The best set of this processor, or the one forced by set_isa().
Isa active_isa();

/// Restricts extraction to a set, for tests and measurements; unsupported sets fall back to the
/// best below.
/// @return the set now in use.
Isa set_isa(Isa isa);

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
