#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "shape3d/mapping/export.hpp"
#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping {

/// Settings of wrap(). Lengths are given as parts of the diagonal of the bounding box: 20 stands
/// for a twentieth.
struct WrapOptions {
  double coarsest = 4.0;  ///< 1 … finest: the largest α that is tried is diagonal / coarsest.
  double finest = 50.0;   ///< … 1000: the smallest. The time grows with its square.
  double offset = 30.0;   ///< The wrap lies α / offset outside the input; 2 … 1000.
  /// The search ends when the smallest good α is known to within this ratio; 1.001 … 2.
  double ratio = 1.1;
  /// Called between attempts with the share done, 0 … 1; false cancels.
  std::function<bool(double)> progress;
};

enum class WrapStatus {
  ok,         ///< A wrap of genus 0.
  no_sphere,  ///< Every α that was tried left handles or several pieces; no mesh.
  cancelled   ///< The caller's progress function returned false; no mesh.
};

/// One plain sentence part.
[[nodiscard]] SHAPE3D_MAPPING_EXPORT std::string_view to_string(WrapStatus status);

/// One α that was tried.
struct WrapAttempt {
  double alpha = 0.0;
  std::int64_t triangles = 0, components = 0, euler = 0;
};

/// Outcome of wrap().
struct Wrapped {
  Points V;
  Triangles F;  ///< Closed, oriented manifold without self-intersections, genus 0.
  WrapStatus status = WrapStatus::no_sphere;
  double alpha = 0.0, offset = 0.0;   ///< In the unit of V.
  std::vector<WrapAttempt> attempts;  ///< In the order they were made.
};

/// A closed surface of genus 0 round any triangles: CGAL's 3D alpha wrap, which shrinks from
/// outside as far as a ball of radius α gets, with the smallest α for which it is one piece of
/// Euler characteristic 2.
///
/// The genus does not fall steadily with α. The search goes down from coarsest to finest by the
/// ratio 1.5; from the last α before the first bad one (or from finest) it halves the step until
/// the ratio is reached. So the result is the end of the first run of good α, not of all.
///
/// Everything of the input is inside, at a distance of `offset` at least; passages narrower than 2
/// α are closed; inner cavities are lost; details below α are smoothed.
///
/// @param V  #V by 3, finite.
/// @param F  #F by 3 rows of V, at least 1, any: open, crossing, non-manifold.
/// @throws std::invalid_argument  a coordinate is not finite; an index is out of range; all
/// vertices of triangles coincide; an option is out of range.
///
/// Deterministic. About 10 s for 20k triangles with the default finest; four times as long for
/// twice that.
/// @cite Portaneri, Rouxel-Labbé, Hemmer, Cohen-Steiner, Alliez 2022.
[[nodiscard]] SHAPE3D_MAPPING_EXPORT Wrapped wrap(const ConstPoints& V, const ConstTriangles& F,
                                                  const WrapOptions& options = {});

}  // namespace shape3d::mapping
