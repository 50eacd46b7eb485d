#include "generated.hpp"

#include <cmath>

#include "random_numbers.hpp"

using namespace shape3d::learning;

GeneratedSet gaussian_clouds(int items, int dimension, int classes, double spread,
                             std::uint64_t seed) {
  detail::RandomNumbers random(seed);
  Features centres(classes, dimension);
  for (double& x : centres.reshaped()) x = spread * random.normal();
  GeneratedSet set;
  for (int i = 0; i < items; ++i) {
    set.labels.push_back(0);
    auto rest =
        static_cast<int>(random.below(static_cast<std::uint64_t>(classes * (classes + 1) / 2)));
    for (int c = 0; rest > c; ++c) {
      rest -= c + 1;
      set.labels.back() = c + 1;
    }
  }
  set.X.resize(items, dimension);
  for (int i = 0; i < items; ++i) {
    for (int j = 0; j < dimension; ++j) {
      const double unit = std::pow(10.0, j % 5 - 2);
      set.X(i, j) = unit * (centres(set.labels[static_cast<std::size_t>(i)], j) + random.normal());
    }
  }
  return set;
}
