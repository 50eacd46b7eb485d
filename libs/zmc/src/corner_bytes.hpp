#pragma once

#include <array>
#include <cstdint>

#include "isa.hpp"
#include "sign_lattice.hpp"

#if SHAPE3D_ZMC_X86
#include <immintrin.h>
#endif

namespace shape3d::zmc::detail {

/// Bit c of out[i] := bit i of corners[c], for 64 cells: their corner masks (see corner_bit) from
/// eight bit rows.
using CornerBytes = void (*)(const std::array<Word, 8>& corners, std::uint8_t* out);

/// The implementation for an instruction set.
CornerBytes corner_bytes(Isa isa);

#if SHAPE3D_ZMC_X86
/// Transposes four blocks of 8 x 8 bits, bytes being rows (Hacker's Delight, 7-3).
SHAPE3D_ZMC_TARGET_AVX2 inline __attribute__((always_inline)) __m256i transpose_bits(__m256i x) {
  const __m256i pairs = _mm256_set1_epi64x(0x00AA00AA00AA00AA),
                fours = _mm256_set1_epi64x(0x0000CCCC0000CCCC),
                eights = _mm256_set1_epi64x(0x00000000F0F0F0F0);
  __m256i t = _mm256_and_si256(_mm256_xor_si256(x, _mm256_srli_epi64(x, 7)), pairs);
  x = _mm256_xor_si256(_mm256_xor_si256(x, t), _mm256_slli_epi64(t, 7));
  t = _mm256_and_si256(_mm256_xor_si256(x, _mm256_srli_epi64(x, 14)), fours);
  x = _mm256_xor_si256(_mm256_xor_si256(x, t), _mm256_slli_epi64(t, 14));
  t = _mm256_and_si256(_mm256_xor_si256(x, _mm256_srli_epi64(x, 28)), eights);
  return _mm256_xor_si256(_mm256_xor_si256(x, t), _mm256_slli_epi64(t, 28));
}

SHAPE3D_ZMC_TARGET_AVX2 inline __attribute__((always_inline)) void put_corner_bytes_avx2(
    const std::array<Word, 8>& corners, std::uint8_t* out) {
  // Bytes first: octet o of the eight words becomes quarter o.
  const auto word = [&](std::size_t c) SHAPE3D_ZMC_TARGET_AVX2 {
    return _mm_loadl_epi64(reinterpret_cast<const __m128i*>(&corners[c]));
  };
  const __m128i b01 = _mm_unpacklo_epi8(word(0), word(1)),
                b23 = _mm_unpacklo_epi8(word(2), word(3)),
                b45 = _mm_unpacklo_epi8(word(4), word(5)),
                b67 = _mm_unpacklo_epi8(word(6), word(7));
  const __m128i low03 = _mm_unpacklo_epi16(b01, b23), high03 = _mm_unpackhi_epi16(b01, b23),
                low47 = _mm_unpacklo_epi16(b45, b67), high47 = _mm_unpackhi_epi16(b45, b67);
  const __m256i first = _mm256_set_m128i(_mm_unpackhi_epi32(low03, low47),
                                         _mm_unpacklo_epi32(low03, low47)),
                second = _mm256_set_m128i(_mm_unpackhi_epi32(high03, high47),
                                          _mm_unpacklo_epi32(high03, high47));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), transpose_bits(first));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(out + 32), transpose_bits(second));
}
#endif

}  // namespace shape3d::zmc::detail
