// Certifies the octahedron as a map to the sphere.
#include <cstdio>

#include <shape3d/mapping/certificate.hpp>

int main() {
  shape3d::mapping::Points S(6, 3);
  S << 1, 0, 0, 0, 1, 0, 0, 0, 1, -1, 0, 0, 0, -1, 0, 0, 0, -1;
  shape3d::mapping::Triangles F(8, 3);
  F << 0, 1, 2, 1, 3, 2, 3, 4, 2, 4, 0, 2, 1, 0, 5, 3, 1, 5, 4, 3, 5, 0, 4, 5;
  const shape3d::mapping::Certificate certificate = shape3d::mapping::certify(S, F);
  std::printf("degree %lld, total solid angle %.3f\n", static_cast<long long>(certificate.degree),
              certificate.total_solid_angle);
  return certificate.bijective() ? 0 : 1;
}
