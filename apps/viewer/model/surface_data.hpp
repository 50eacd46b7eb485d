#pragma once

#include <cstdint>
#include <vector>

#include <vtkSmartPointer.h>
#include <shape3d/zmc/surface.hpp>

class vtkPolyData;

namespace shape3d::apps {
struct Mesh;
}

namespace shape3d::apps::viewer {

using Surface = zmc::Surface<float, std::int32_t>;

/// Pairs of vertices: the edges of a surface that belong to more than two triangles. Only edges
/// between two samples equal to the isovalue can.
/// @pre  surface was made with Options::edges, or is empty.
[[nodiscard]] std::vector<std::int32_t> nonmanifold_edges(const Surface& surface);

/// The triangles of kind zero_face alone: cell faces whose four samples equal the isovalue. Null
/// when there is none.
[[nodiscard]] vtkSmartPointer<vtkPolyData> zero_faces(const Surface& surface);

/// Edges as lines; null when there is none.
[[nodiscard]] vtkSmartPointer<vtkPolyData> line_data(const Surface& surface,
                                                     const std::vector<std::int32_t>& edges);

/// A surface as VTK sees it, with its normals; the memory is handed over, not copied.
[[nodiscard]] vtkSmartPointer<vtkPolyData> surface_data(Surface&& surface);

/// A mesh with normals at its vertices, the mean of those of its triangles by area; float
/// coordinates.
[[nodiscard]] vtkSmartPointer<vtkPolyData> mesh_data(const Mesh& mesh);

/// The same points and triangles, without a copy, in objects that another thread may use: VTK's
/// keep bounds and places of traversal.
[[nodiscard]] vtkSmartPointer<vtkPolyData> twin_of(vtkPolyData* surface);

/// A surface of about `triangles` triangles for turning, by clustering vertices; null when the
/// surface has few enough anyway.
[[nodiscard]] vtkSmartPointer<vtkPolyData> level_of_detail(vtkPolyData* surface,
                                                           std::int64_t triangles);

}  // namespace shape3d::apps::viewer
