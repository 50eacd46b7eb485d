// Maps an octahedron, stretched along an axis, to the sphere.
#include <cstdio>
#include <string>

#include <shape3d/mapping/spherical_map.hpp>

int main() {
  shape3d::mapping::Points V(6, 3);
  V << 2, 0, 0, 0, 1, 0, 0, 0, 1, -2, 0, 0, 0, -1, 0, 0, 0, -1;
  shape3d::mapping::Triangles F(8, 3);
  F << 0, 1, 2, 1, 3, 2, 3, 4, 2, 4, 0, 2, 1, 0, 5, 3, 1, 5, 4, 3, 5, 0, 4, 5;
  const shape3d::mapping::SphericalMap map = shape3d::mapping::spherical_map(V, F);
  std::printf("%s; mean angle change %.2f degrees\n", std::string(to_string(map.status)).c_str(),
              map.distortion.angle_change.mean);
  return map.status == shape3d::mapping::Status::certified && map.S.rows() == 6 ? 0 : 1;
}
