#pragma once

#include "mesh.hpp"

namespace shape3d::apps {

/// Unit normals at the vertices, by the areas of their triangles; 0 where these have none.
[[nodiscard]] Mesh::Points vertex_normals(const Mesh& mesh);

}  // namespace shape3d::apps
