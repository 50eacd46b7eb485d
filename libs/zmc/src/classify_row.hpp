#pragma once

// The comparison of one row of samples with the isovalue, for each instruction set.

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

/// Words of one row.
struct RowWords {
  Word* negative;
  Word* zero;
  Word* not_finite;  ///< Only written for reals.
};

/// Compares `count` contiguous samples; bits beyond them are 0.
template <class T>
void classify_samples(const T* samples, std::int64_t count, const Threshold<T>& threshold,
                      const RowWords& words);

}  // namespace shape3d::zmc::detail
