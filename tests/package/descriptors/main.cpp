// Measures a tetrahedron and prints its area: 3 · ½ + √3/2.
#include <cmath>
#include <cstdio>

#include <shape3d/descriptors/surface.hpp>

int main() {
  shape3d::descriptors::Points V(4, 3);
  V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  shape3d::descriptors::Triangles F(4, 3);
  F << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
  const double area = shape3d::descriptors::surface_area(V, F);
  std::printf("area = %.15f\n", area);
  return std::abs(area - (1.5 + std::sqrt(0.75))) < 1e-14 ? 0 : 1;
}
