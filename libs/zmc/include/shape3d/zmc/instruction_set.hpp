#pragma once

#include <string_view>

#include "shape3d/zmc/export.hpp"

namespace shape3d::zmc {

/// Instruction sets that extraction has loops for; each includes those before it. Results do not
/// depend on it.
enum class InstructionSet {
  portable,  ///< What the compiler was told to assume.
  avx2,      ///< AVX2, BMI1, BMI2, POPCNT, LZCNT.
  avx512     ///< AVX-512 F, BW, VL, DQ, VPOPCNTDQ.
};

[[nodiscard]] SHAPE3D_ZMC_EXPORT std::string_view to_string(InstructionSet set);

/// The set in use: the best of this processor, unless use_instruction_set() chose another.
[[nodiscard]] SHAPE3D_ZMC_EXPORT InstructionSet active_instruction_set();

/// Chooses a set for all extractions from now on, for tests and measurements.
/// @return the set now in use: the best that the processor has up to the one asked for.
SHAPE3D_ZMC_EXPORT InstructionSet use_instruction_set(InstructionSet set);

}  // namespace shape3d::zmc
