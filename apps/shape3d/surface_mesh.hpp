#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <shape3d/zmc/surface.hpp>

#include "common/mesh.hpp"

namespace shape3d::apps {

/// A surface with 32-bit ids, or with 64-bit ids when those do not suffice.
using AnySurface =
    std::variant<zmc::Surface<double, std::int32_t>, zmc::Surface<double, std::int64_t>>;

/// What a file format needs of a surface, borrowed.
[[nodiscard]] MeshView view_of(const AnySurface& surface);

/// Changes between LPS and RAS: x and y change sign, which is a rotation.
void turn_about_z(AnySurface& surface);

/// Surfaces one after another in one mesh, with the arrays `isovalue` of vertices and triangles and
/// `kind` of triangles (0 patch, 1 zero face, 2 closing).
class SurfaceCollection {
 public:
  SurfaceCollection();
  /// Appends a surface. Ids become 64-bit when 32 bits do not suffice.
  void add(const AnySurface& surface, double isovalue);
  /// Valid until the next add().
  [[nodiscard]] MeshView view() const;

 private:
  std::vector<double> positions_;
  std::variant<std::vector<std::int32_t>, std::vector<std::int64_t>> indices_;
  std::vector<MeshArray> vertex_arrays_, triangle_arrays_;
};

/// The arrays of a single surface.
[[nodiscard]] std::vector<MeshArray> vertex_arrays_of(const AnySurface& surface, double isovalue);
[[nodiscard]] std::vector<MeshArray> triangle_arrays_of(const AnySurface& surface, double isovalue);

}  // namespace shape3d::apps
