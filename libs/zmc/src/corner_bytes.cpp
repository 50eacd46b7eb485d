#include "corner_bytes.hpp"

#include <cstring>

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
  put_corner_bytes_avx2(corners, out);
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
