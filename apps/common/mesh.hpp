#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace shape3d::apps {

/// One number per vertex or per triangle of a mesh.
struct MeshArray {
  std::string name;
  std::variant<std::vector<std::uint8_t>, std::vector<double>> values;
};

/// Triangle mesh with shared vertices.
struct Mesh {
  using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  using Triangles = Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor>;

  Points V;     ///< #V by 3, finite; the unit is the file's (millimetres for medical data).
  Triangles F;  ///< #F by 3 rows of V, counter-clockwise seen from outside.
  std::vector<MeshArray> vertex_arrays;    ///< #V values each.
  std::vector<MeshArray> triangle_arrays;  ///< #F values each.
  std::vector<std::string> comments;  ///< Single lines of text, without the marks of the format.
  std::string space;                  ///< "LPS", "RAS" or empty when the file does not say.
};

/// What the writers and check_mesh() need of a mesh, without a copy: borrowed positions, and vertex
/// ids of 32 or 64 bits.
struct MeshView {
  const double* positions = nullptr;  ///< x y z of vertex 0 first.
  std::int64_t vertex_count = 0;
  std::variant<const std::int32_t*, const std::int64_t*> indices =
      static_cast<const std::int32_t*>(nullptr);
  std::int64_t triangle_count = 0;
  std::vector<MeshArray> const* vertex_arrays = nullptr;
  std::vector<MeshArray> const* triangle_arrays = nullptr;
  std::vector<std::string> comments;
  std::string space;
};

/// View of a mesh that must outlive it.
[[nodiscard]] inline MeshView view_of(const Mesh& mesh) {
  MeshView view;
  view.positions = mesh.V.data();
  view.vertex_count = mesh.V.rows();
  view.indices = mesh.F.data();
  view.triangle_count = mesh.F.rows();
  view.vertex_arrays = &mesh.vertex_arrays;
  view.triangle_arrays = &mesh.triangle_arrays;
  view.comments = mesh.comments;
  view.space = mesh.space;
  return view;
}

}  // namespace shape3d::apps
