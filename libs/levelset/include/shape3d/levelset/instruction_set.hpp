#pragma once

#include <string_view>

#include "shape3d/levelset/export.hpp"

namespace shape3d::levelset {

/// Instruction sets that the loops over rows are made for. Results do not depend on it.
enum class InstructionSet {
  portable,  ///< What the compiler was told to assume.
  avx2       ///< AVX2, without fused multiply-add.
};

[[nodiscard]] SHAPE3D_LEVELSET_EXPORT std::string_view to_string(InstructionSet set);

/// The set in use: the best of this processor, unless use_instruction_set() chose another.
[[nodiscard]] SHAPE3D_LEVELSET_EXPORT InstructionSet active_instruction_set();

/// Chooses a set for all computations from now on, for tests and measurements.
/// @return the set now in use: the best that the processor has up to the one asked for.
SHAPE3D_LEVELSET_EXPORT InstructionSet use_instruction_set(InstructionSet set);

}  // namespace shape3d::levelset
