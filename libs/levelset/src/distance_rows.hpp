#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "row_reach.hpp"

namespace shape3d::levelset::detail {

/// What the distance loops need of a grid.
struct Spacings {
  float h[3];        ///< mm
  float inverse[3];  ///< 1/h
  float weight[3];   ///< 1/h²

  explicit Spacings(const Eigen::Vector3d& spacing) {
    for (int a = 0; a < 3; ++a) {
      h[a] = static_cast<float>(spacing[a]);
      inverse[a] = static_cast<float>(1.0 / spacing[a]);
      weight[a] = inverse[a] * inverse[a];
    }
  }
};

/// The field whose zero set is meant: sign · (f − level).
struct LevelOf {
  float level = 0.0F, sign = 1.0F;
};

/// What nodes that are not beside the zero set get.
enum class Far {
  cut,  ///< ±limit.
  kept  ///< What they have, cut at ±limit: a start for relax_distance() that is nearly right.
};

/// The nodes of a tile beside a zero set.
struct Beside {
  int nodes = 0;
  HalfRows rows;
  std::array<std::uint8_t, 64> by_row{};  ///< Nodes of each row.

  /// Takes the rows of a mask from `other`.
  void replace(RowMask mask, const Beside& other) {
    rows.low = (rows.low & ~mask) | (other.rows.low & mask);
    rows.high = (rows.high & ~mask) | (other.rows.high & mask);
    for (RowMask rest = mask; rest != 0; rest &= rest - 1) {
      const auto row = static_cast<std::size_t>(__builtin_ctzll(rest));
      nodes += other.by_row[row] - by_row[row];
      by_row[row] = other.by_row[row];
    }
  }
};

/// Signed distance of the nodes beside the zero set, 0 at zeros, in the rows of a mask.
///
/// A node is beside it when one of its six neighbours has the other sign or is zero. Its distance
/// is |v| over the length of the one-sided slopes (|v| − n)/h towards the lower neighbour n of each
/// axis (n < 0 across the front): that to the plane through the crossings, which lie where linear
/// interpolation puts them, also where a crossing is more than one spacing away. Where both sides
/// of an axis are crossed the object is one node thin and has no such plane: there it is the
/// distance to the nearest crossing, which leaves the crossings where they are.
/// @param field  Padded, as `out`.
Beside distance_beside(const TileRows& rows, RowMask mask, const float* field, LevelOf level,
                       const Spacings& spacings, float limit, Far far, float* out);

/// One step of Jacobi's kind of the eikonal equation |∇d| = 1 (Rouy and Tourin's upwind scheme) at
/// the nodes that are not beside the zero set; those keep their value. After n steps the nodes that
/// are n away from them are right.
void relax_distance(const TileRows& rows, RowMask mask, const float* distance,
                    const Spacings& spacings, float limit, float* out);

}  // namespace shape3d::levelset::detail
