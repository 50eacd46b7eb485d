#include "classify_row.hpp"

#include <algorithm>
#include <cstring>

#include "isa.hpp"

#if SHAPE3D_ZMC_X86
#include <immintrin.h>
// GCC 12 takes the undefined pass-through operand inside its own intrinsics for a use (GCC bug
// 105593).
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

namespace shape3d::zmc::detail {
namespace {

/// 0 or 255 for each of 64 samples, by comparison.
struct Bytes {
  alignas(64) std::uint8_t negative[64] = {}, zero[64] = {}, not_finite[64] = {};
};

template <class T>
inline __attribute__((always_inline)) void compare(const T* samples, int count,
                                                   const Threshold<T>& threshold, Bytes& bytes) {
  const T bound = threshold.bound, value = threshold.zero;
  if (threshold.above) {
    for (int i = 0; i < count; ++i) bytes.negative[i] = samples[i] > bound ? 255 : 0;
  } else {
    for (int i = 0; i < count; ++i) bytes.negative[i] = samples[i] < bound ? 255 : 0;
  }
  for (int i = 0; i < count; ++i) bytes.zero[i] = samples[i] == value ? 255 : 0;
  if constexpr (std::is_floating_point_v<T>) {
    constexpr T kLargest = std::numeric_limits<T>::max();
    for (int i = 0; i < count; ++i)
      bytes.not_finite[i] = std::abs(samples[i]) <= kLargest ? 0 : 255;
  }
}

/// One bit of each byte.
Word pack_portable(const std::uint8_t* bytes) {
  Word word = 0;
  for (int octet = 0; octet < 8; ++octet) {
    Word eight = 0;
    std::memcpy(&eight, bytes + 8 * octet, 8);
    word |= (((eight & 0x0101010101010101u) * 0x0102040810204080u) >> 56) << (8 * octet);
  }
  return word;
}

template <class T>
void classify_portable(const T* samples, std::int64_t count, const Threshold<T>& threshold,
                       const RowWords& words) {
  for (std::int64_t w = 0; 64 * w < count; ++w) {
    Bytes bytes;
    compare(samples + 64 * w, static_cast<int>(std::min<std::int64_t>(64, count - 64 * w)),
            threshold, bytes);
    words.negative[w] = pack_portable(bytes.negative);
    words.zero[w] = threshold.has_zero ? pack_portable(bytes.zero) : 0;
    if constexpr (std::is_floating_point_v<T>)
      words.not_finite[w] = pack_portable(bytes.not_finite);
  }
}

#if SHAPE3D_ZMC_X86
SHAPE3D_ZMC_TARGET_AVX2 Word pack_avx2(const std::uint8_t* bytes) {
  const auto half = [&](int h) SHAPE3D_ZMC_TARGET_AVX2 {
    const __m256i v = _mm256_load_si256(reinterpret_cast<const __m256i*>(bytes + 32 * h));
    return static_cast<Word>(static_cast<std::uint32_t>(_mm256_movemask_epi8(v)));
  };
  return half(0) | half(1) << 32;
}

template <class T>
SHAPE3D_ZMC_TARGET_AVX2 void classify_avx2(const T* samples, std::int64_t count,
                                           const Threshold<T>& threshold, const RowWords& words) {
  for (std::int64_t w = 0; 64 * w < count; ++w) {
    Bytes bytes;
    if (64 * w + 64 <= count) {
      compare(samples + 64 * w, 64, threshold, bytes);
    } else {
      compare(samples + 64 * w, static_cast<int>(count - 64 * w), threshold, bytes);
    }
    words.negative[w] = pack_avx2(bytes.negative);
    words.zero[w] = threshold.has_zero ? pack_avx2(bytes.zero) : 0;
    if constexpr (std::is_floating_point_v<T>) words.not_finite[w] = pack_avx2(bytes.not_finite);
  }
}

/// Comparisons of one vector of samples, lanes by `mask`.
template <class T>
struct Avx512Lanes;

#define SHAPE3D_ZMC_AVX512_LANES(type, lanes, bits, suffix, load, set)                  \
  template <>                                                                           \
  struct Avx512Lanes<type> {                                                            \
    static constexpr int kLanes = lanes;                                                \
    SHAPE3D_ZMC_TARGET_AVX512 static Word below(const type* p, Word mask, type bound) { \
      const auto m = static_cast<bits>(mask);                                           \
      return _mm512_mask_cmplt_##suffix##_mask(m, load(m, p), set(bound));              \
    }                                                                                   \
    SHAPE3D_ZMC_TARGET_AVX512 static Word above(const type* p, Word mask, type bound) { \
      const auto m = static_cast<bits>(mask);                                           \
      return _mm512_mask_cmpgt_##suffix##_mask(m, load(m, p), set(bound));              \
    }                                                                                   \
    SHAPE3D_ZMC_TARGET_AVX512 static Word equal(const type* p, Word mask, type value) { \
      const auto m = static_cast<bits>(mask);                                           \
      return _mm512_mask_cmpeq_##suffix##_mask(m, load(m, p), set(value));              \
    }                                                                                   \
  }
#define SHAPE3D_ZMC_SET8(value) _mm512_set1_epi8(static_cast<char>(value))
#define SHAPE3D_ZMC_SET16(value) _mm512_set1_epi16(static_cast<short>(value))
SHAPE3D_ZMC_AVX512_LANES(std::int8_t, 64, __mmask64, epi8, _mm512_maskz_loadu_epi8,
                         SHAPE3D_ZMC_SET8);
SHAPE3D_ZMC_AVX512_LANES(std::uint8_t, 64, __mmask64, epu8, _mm512_maskz_loadu_epi8,
                         SHAPE3D_ZMC_SET8);
SHAPE3D_ZMC_AVX512_LANES(std::int16_t, 32, __mmask32, epi16, _mm512_maskz_loadu_epi16,
                         SHAPE3D_ZMC_SET16);
SHAPE3D_ZMC_AVX512_LANES(std::uint16_t, 32, __mmask32, epu16, _mm512_maskz_loadu_epi16,
                         SHAPE3D_ZMC_SET16);
SHAPE3D_ZMC_AVX512_LANES(std::int32_t, 16, __mmask16, epi32, _mm512_maskz_loadu_epi32,
                         _mm512_set1_epi32);
#undef SHAPE3D_ZMC_AVX512_LANES
#undef SHAPE3D_ZMC_SET8
#undef SHAPE3D_ZMC_SET16

template <>
struct Avx512Lanes<float> {
  static constexpr int kLanes = 16;
  template <int kPredicate>
  SHAPE3D_ZMC_TARGET_AVX512 static Word compare(const float* p, Word mask, float bound) {
    const auto m = static_cast<__mmask16>(mask);
    return _mm512_mask_cmp_ps_mask(m, _mm512_maskz_loadu_ps(m, p), _mm512_set1_ps(bound),
                                   kPredicate);
  }
  SHAPE3D_ZMC_TARGET_AVX512 static Word not_finite(const float* p, Word mask) {
    const auto m = static_cast<__mmask16>(mask);
    const __m512 size = _mm512_abs_ps(_mm512_maskz_loadu_ps(m, p));
    return _mm512_mask_cmp_ps_mask(m, size, _mm512_set1_ps(std::numeric_limits<float>::max()),
                                   _CMP_NLE_UQ);
  }
};
template <>
struct Avx512Lanes<double> {
  static constexpr int kLanes = 8;
  template <int kPredicate>
  SHAPE3D_ZMC_TARGET_AVX512 static Word compare(const double* p, Word mask, double bound) {
    const auto m = static_cast<__mmask8>(mask);
    return _mm512_mask_cmp_pd_mask(m, _mm512_maskz_loadu_pd(m, p), _mm512_set1_pd(bound),
                                   kPredicate);
  }
  SHAPE3D_ZMC_TARGET_AVX512 static Word not_finite(const double* p, Word mask) {
    const auto m = static_cast<__mmask8>(mask);
    const __m512d size = _mm512_abs_pd(_mm512_maskz_loadu_pd(m, p));
    return _mm512_mask_cmp_pd_mask(m, size, _mm512_set1_pd(std::numeric_limits<double>::max()),
                                   _CMP_NLE_UQ);
  }
};

template <class T>
SHAPE3D_ZMC_TARGET_AVX512 void classify_avx512(const T* samples, std::int64_t count,
                                               const Threshold<T>& threshold,
                                               const RowWords& words) {
  using Lanes = Avx512Lanes<T>;
  for (std::int64_t w = 0; 64 * w < count; ++w) {
    const Word in_row = below_mask(count, w);
    Word negative = 0, zero = 0, bad = 0;
    for (int part = 0; part < 64; part += Lanes::kLanes) {
      const Word mask =
          Lanes::kLanes == 64 ? in_row : (in_row >> part) & ((Word{1} << (Lanes::kLanes & 63)) - 1);
      const T* p = samples + 64 * w + part;
      if constexpr (std::is_floating_point_v<T>) {
        negative |=
            (threshold.above ? Lanes::template compare<_CMP_GT_OQ>(p, mask, threshold.bound)
                             : Lanes::template compare<_CMP_LT_OQ>(p, mask, threshold.bound))
            << part;
        zero |= Lanes::template compare<_CMP_EQ_OQ>(p, mask, threshold.zero) << part;
        bad |= Lanes::not_finite(p, mask) << part;
      } else {
        negative |= (threshold.above ? Lanes::above(p, mask, threshold.bound)
                                     : Lanes::below(p, mask, threshold.bound))
                    << part;
        zero |= Lanes::equal(p, mask, threshold.zero) << part;
      }
    }
    words.negative[w] = negative;
    words.zero[w] = threshold.has_zero ? zero : 0;
    if constexpr (std::is_floating_point_v<T>) words.not_finite[w] = bad;
  }
}
#endif

}  // namespace

template <class T>
void classify_samples(const T* samples, std::int64_t count, const Threshold<T>& threshold,
                      const RowWords& words) {
  switch (active_isa()) {
#if SHAPE3D_ZMC_X86
    case Isa::avx512:
      return classify_avx512(samples, count, threshold, words);
    case Isa::avx2:
      return classify_avx2(samples, count, threshold, words);
#else
    case Isa::avx512:
    case Isa::avx2:
#endif
    case Isa::portable:
      break;
  }
  classify_portable(samples, count, threshold, words);
}

template void classify_samples(const std::int8_t*, std::int64_t, const Threshold<std::int8_t>&,
                               const RowWords&);
template void classify_samples(const std::uint8_t*, std::int64_t, const Threshold<std::uint8_t>&,
                               const RowWords&);
template void classify_samples(const std::int16_t*, std::int64_t, const Threshold<std::int16_t>&,
                               const RowWords&);
template void classify_samples(const std::uint16_t*, std::int64_t, const Threshold<std::uint16_t>&,
                               const RowWords&);
template void classify_samples(const std::int32_t*, std::int64_t, const Threshold<std::int32_t>&,
                               const RowWords&);
template void classify_samples(const float*, std::int64_t, const Threshold<float>&,
                               const RowWords&);
template void classify_samples(const double*, std::int64_t, const Threshold<double>&,
                               const RowWords&);

}  // namespace shape3d::zmc::detail
