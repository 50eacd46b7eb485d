#pragma once

// Vectors of numbers that work alike with and without AVX2: GCC and Clang make one or two registers
// of them. A loop is written once, always inlined, and called from one function per instruction
// set.

#include <cstddef>
#include <cstring>

#define SHAPE3D_DESCRIPTORS_INLINE __attribute__((always_inline)) inline
#if defined(__x86_64__)
#define SHAPE3D_DESCRIPTORS_AVX2 __attribute__((target("avx2")))
#else
#define SHAPE3D_DESCRIPTORS_AVX2
#endif

namespace shape3d::descriptors::detail {

inline constexpr std::size_t kLanes = 4;  ///< Doubles in Lanes.
using Lanes = double __attribute__((vector_size(32)));

inline constexpr std::size_t kFloatLanes = 8;  ///< Floats in FloatLanes.
using FloatLanes = float __attribute__((vector_size(32)));

SHAPE3D_DESCRIPTORS_INLINE void load(Lanes& lanes, const double* values) {
  std::memcpy(&lanes, values, sizeof lanes);
}

SHAPE3D_DESCRIPTORS_INLINE void set(Lanes& lanes, double value) {
  const double values[kLanes] = {value, value, value, value};
  load(lanes, values);
}

SHAPE3D_DESCRIPTORS_INLINE void load(FloatLanes& lanes, const float* values) {
  std::memcpy(&lanes, values, sizeof lanes);
}

SHAPE3D_DESCRIPTORS_INLINE void set(FloatLanes& lanes, float value) {
  const float values[kFloatLanes] = {value, value, value, value, value, value, value, value};
  load(lanes, values);
}

SHAPE3D_DESCRIPTORS_INLINE double sum(const Lanes& lanes) {
  return (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]);
}

/// Whether the processor has AVX2.
inline bool has_avx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

}  // namespace shape3d::descriptors::detail
