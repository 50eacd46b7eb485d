#pragma once

// The comparison of one row of samples with the isovalue.

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "shape3d/zmc/options.hpp"
#include "sign_lattice.hpp"

namespace shape3d::zmc::detail {

/// Comparison with a real isovalue said in the sample type itself, where it is exact: a sample is
/// negative when it is below `bound` (above it when `above`), zero when it equals `zero`.
template <class T>
struct Threshold {
  enum class Rule { compare, all_negative, none_negative };
  Rule rule = Rule::compare;
  bool above = false;
  T bound{};
  bool has_zero = false;  ///< Whether the isovalue is a value of T.
  T zero{};

  Threshold(double isovalue, Inside inside) : above(inside == Inside::above) {
    if constexpr (std::is_floating_point_v<T>) {
      auto nearest = static_cast<T>(isovalue);
      if (std::isinf(nearest)) nearest = std::copysign(std::numeric_limits<T>::max(), nearest);
      has_zero = static_cast<double>(nearest) == isovalue;
      zero = nearest;
      bound = nearest;
      constexpr T kInfinity = std::numeric_limits<T>::infinity();
      if (!above && static_cast<double>(nearest) < isovalue)
        bound = std::nextafter(nearest, kInfinity);
      if (above && static_cast<double>(nearest) > isovalue)
        bound = std::nextafter(nearest, -kInfinity);
    } else {
      const double limit = above ? std::floor(isovalue) : std::ceil(isovalue);
      const auto lowest = static_cast<double>(std::numeric_limits<T>::lowest());
      const auto highest = static_cast<double>(std::numeric_limits<T>::max());
      if (limit < lowest) {
        rule = above ? Rule::all_negative : Rule::none_negative;
      } else if (limit > highest) {
        rule = above ? Rule::none_negative : Rule::all_negative;
      } else {
        bound = static_cast<T>(limit);
        has_zero = limit == isovalue;
        zero = bound;
      }
    }
  }
};

/// Up to 64 contiguous samples → negative bits, zero bits, and for reals the bits of those not
/// finite.
template <class T>
inline void classify_word(const T* samples, int count, const Threshold<T>& threshold,
                          Word& negative, Word& zero, Word& not_finite) {
  alignas(64) std::uint8_t n[64] = {}, z[64] = {}, b[64] = {};
  const T bound = threshold.bound, value = threshold.zero;
  if (threshold.above) {
    for (int i = 0; i < count; ++i) n[i] = samples[i] > bound;
  } else {
    for (int i = 0; i < count; ++i) n[i] = samples[i] < bound;
  }
  for (int i = 0; i < count; ++i) z[i] = samples[i] == value;
  if constexpr (std::is_floating_point_v<T>) {
    for (int i = 0; i < count; ++i) b[i] = !(std::abs(samples[i]) <= std::numeric_limits<T>::max());
  }
  const auto pack = [](const std::uint8_t* bytes) {
    Word word = 0;
    for (int octet = 0; octet < 8; ++octet) {
      Word eight = 0;
      __builtin_memcpy(&eight, bytes + 8 * octet, 8);  // one 0/1 byte a sample → one bit a sample
      word |= ((eight * 0x0102040810204080u) >> 56) << (8 * octet);
    }
    return word;
  };
  negative = pack(n);
  zero = threshold.has_zero ? pack(z) : 0;
  not_finite = std::is_floating_point_v<T> ? pack(b) : 0;
}

}  // namespace shape3d::zmc::detail
