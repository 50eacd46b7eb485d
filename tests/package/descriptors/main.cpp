// Describes a tetrahedron by hyperspherical harmonics and prints the length of the vector and its
// norm. Fails unless there are 45 numbers that do not change when two axes are exchanged.
#include <cmath>
#include <cstdio>

#include <shape3d/descriptors/descriptor.hpp>

int main() {
  using namespace shape3d::descriptors;
  Points V(4, 3);
  V << 0, 0, 0, 3, 0, 0, 0, 2, 0, 0, 0, 1;
  Triangles F(4, 3);
  F << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
  const Descriptor descriptor = Descriptor::parse("hsh:map=equal_volume,K=8,voxels=32");
  const Eigen::VectorXd vector = descriptor.compute(V, F);
  V.col(0).swap(V.col(1));
  const Eigen::VectorXd mirrored = descriptor.compute(V, F);
  std::printf("%s\n%d numbers, norm %.6f\n", descriptor.to_string().c_str(),
              static_cast<int>(vector.size()), vector.norm());
  return vector.size() == 45 && (vector - mirrored).norm() < 1e-4 * vector.norm() ? 0 : 1;
}
