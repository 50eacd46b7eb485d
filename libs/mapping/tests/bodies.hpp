#pragma once

#include <random>
#include <string>
#include <vector>

#include "shape3d/mapping/mesh.hpp"

/// Meshes of known surfaces.
namespace shape3d::mapping::test {

struct Body {
  Points V;
  Triangles F;
  std::string name;
};

/// Unit sphere: an icosahedron of which each triangle is cut in four, `level` times, and the new
/// vertices are moved to the sphere. 20 · 4^level triangles.
Body sphere(int level);

/// The surface of the cube [−1, 1]³ in twelve meshings: diagonals either way, fans, even and uneven
/// grids, random points, slivers, refined in a corner. All closed and oriented.
std::vector<Body> cubes_meshed_twelve_ways();

/// Each triangle becomes three round a random inner point; the surface stays the same.
Body split_at_random_points(const Body& body, std::mt19937& random);

/// Torus round the z axis: ((R + r cos φ) cos θ, (R + r cos φ) sin θ, r sin φ), θ = 2π i / n for
/// vertex i + n j, φ = 2π j / m, so that vertices are on the surface; 2 n m triangles.
Body torus(double R, double r, int n, int m);

/// Vertices of the lattice points x, y of a plane patch z = height(x, y); open.
Body patch(int n, double (*height)(double, double));

/// A body whose vertices are numbered in random order, and its triangles too.
Body shuffled(const Body& body, std::mt19937& random);

/// Largest distance of points to a mesh, each to its nearest triangle.
double distance_to_mesh(const Points& from, const Points& V, const Triangles& F);

}  // namespace shape3d::mapping::test
