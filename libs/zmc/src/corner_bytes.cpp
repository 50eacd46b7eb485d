#include "corner_bytes.hpp"

#include <cstring>

#if SHAPE3D_ZMC_X86
#include <immintrin.h>
#endif

namespace shape3d::zmc::detail {
namespace {

void corner_bytes_portable(const std::array<Word, 8>& corners, std::uint8_t* out) {
  for (int octet = 0; octet < 8; ++octet) {
    Word bytes = 0;
    for (int c = 0; c < 8; ++c) {
      // Eight bits, one to the lowest place of each byte.
      const Word bits = (corners[c] >> (8 * octet)) & 0xFFu;
      const Word isolated = (bits * 0x0101010101010101u) & 0x8040201008040201u;
      const Word ones = ((isolated + 0x7F7F7F7F7F7F7F7Fu) | isolated) >> 7;
      bytes |= (ones & 0x0101010101010101u) << c;
    }
    std::memcpy(out + 8 * octet, &bytes, 8);
  }
}

#if SHAPE3D_ZMC_X86
SHAPE3D_ZMC_TARGET_AVX2 void corner_bytes_avx2(const std::array<Word, 8>& corners,
                                               std::uint8_t* out) {
  const __m256i spread = _mm256_setr_epi8(0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2,
                                          2, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 3);
  const __m256i select = _mm256_set1_epi64x(static_cast<long long>(0x8040201008040201u));
  for (int half = 0; half < 2; ++half) {
    __m256i bytes = _mm256_setzero_si256();
    for (int c = 0; c < 8; ++c) {
      const auto bits = static_cast<int>(static_cast<std::uint32_t>(corners[c] >> (32 * half)));
      const __m256i repeated = _mm256_shuffle_epi8(_mm256_set1_epi32(bits), spread);
      const __m256i set = _mm256_cmpeq_epi8(_mm256_and_si256(repeated, select), select);
      bytes = _mm256_or_si256(bytes,
                              _mm256_and_si256(set, _mm256_set1_epi8(static_cast<char>(1 << c))));
    }
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out + 32 * half), bytes);
  }
}

SHAPE3D_ZMC_TARGET_AVX512 void corner_bytes_avx512(const std::array<Word, 8>& corners,
                                                   std::uint8_t* out) {
  __m512i bytes = _mm512_setzero_si512();
  for (int c = 0; c < 8; ++c) {
    bytes = _mm512_mask_add_epi8(bytes, _cvtu64_mask64(corners[c]), bytes,
                                 _mm512_set1_epi8(static_cast<char>(1 << c)));
  }
  _mm512_storeu_si512(out, bytes);
}
#endif

}  // namespace

CornerBytes corner_bytes(Isa isa) {
#if SHAPE3D_ZMC_X86
  if (isa == Isa::avx512) return &corner_bytes_avx512;
  if (isa == Isa::avx2) return &corner_bytes_avx2;
#endif
  static_cast<void>(isa);
  return &corner_bytes_portable;
}

}  // namespace shape3d::zmc::detail
