#pragma once

// Four doubles at a time, in the compiler's own vector types: one source for all instruction sets.

#include <cstdint>
#include <cstring>

namespace shape3d::zmc::detail {

/// Vertices are worked on in whole blocks of so many; their indices are padded.
inline constexpr std::size_t kBlock = 4;

using Doubles = double __attribute__((vector_size(kBlock * sizeof(double))));

/// Loads a block; samples of 32 bits and less exactly.
template <class T>
inline __attribute__((always_inline)) void load_block(const T* from, Doubles& to) {
  using Vector [[gnu::vector_size(kBlock * sizeof(T))]] = T;
  Vector v;
  std::memcpy(&v, from, sizeof v);
  to = __builtin_convertvector(v, Doubles);
}

/// Writes the first n of a block of points, x y z of the first one first.
template <class Real>
inline __attribute__((always_inline)) void store_points(const Doubles (&point)[3], std::size_t n,
                                                        Real* out) {
  using Vector [[gnu::vector_size(kBlock * sizeof(Real))]] = Real;
  const Vector x = __builtin_convertvector(point[0], Vector),
               y = __builtin_convertvector(point[1], Vector),
               z = __builtin_convertvector(point[2], Vector);
  for (std::size_t m = 0; m < n; ++m, out += 3) {
    out[0] = x[m];
    out[1] = y[m];
    out[2] = z[m];
  }
}

}  // namespace shape3d::zmc::detail
