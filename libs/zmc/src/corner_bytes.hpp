#pragma once

#include <array>
#include <cstdint>

#include "isa.hpp"
#include "sign_lattice.hpp"

namespace shape3d::zmc::detail {

/// Bit c of out[i] := bit i of corners[c], for 64 cells: their corner masks (see corner_bit) from
/// eight bit rows.
using CornerBytes = void (*)(const std::array<Word, 8>& corners, std::uint8_t* out);

/// The implementation for an instruction set.
CornerBytes corner_bytes(Isa isa);

}  // namespace shape3d::zmc::detail
