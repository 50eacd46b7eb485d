#include <cmath>
#include <cstdio>
#include <vector>

#include <shape3d/zmc/extract.hpp>

int main() {
  const int n = 64;
  std::vector<float> distance;  // to a sphere of radius 20; negative is inside
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) distance.push_back(std::hypot(i - 32.f, j - 32.f, k - 32.f) - 20);
  const auto surface =
      shape3d::zmc::extract(shape3d::zmc::make_view(distance.data(), {n, n, n}), 0.0);
  std::printf("%td vertices, %td triangles\n", surface.V().rows(), surface.F().rows());
}
