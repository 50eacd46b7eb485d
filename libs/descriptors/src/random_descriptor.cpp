#include <cstring>

#include "random_numbers.hpp"
#include "shape3d/descriptors/shape_distribution.hpp"
#include "text.hpp"

namespace shape3d::descriptors {

Eigen::VectorXd random_descriptor(const Eigen::Ref<const Points>& V,
                                  const Eigen::Ref<const Triangles>& F, int length,
                                  std::uint64_t seed) {
  detail::require_between("length", length, 1, 1 << 24);
  check_surface(V, F);
  std::uint64_t state = detail::RandomNumbers::mix(seed + 1);
  const auto take = [&](std::uint64_t bits) { state = detail::RandomNumbers::mix(state ^ bits); };
  for (Eigen::Index i = 0; i < V.rows(); ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double coordinate = V(i, axis) + 0.0;  // −0 is 0
      std::uint64_t bits = 0;
      std::memcpy(&bits, &coordinate, sizeof bits);
      take(bits);
    }
  }
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    for (Eigen::Index corner = 0; corner < 3; ++corner) {
      take(static_cast<std::uint64_t>(F(t, corner)));
    }
  }
  detail::RandomNumbers numbers(state);
  Eigen::VectorXd vector(length);
  for (double& value : vector) value = numbers.uniform();
  return vector;
}

}  // namespace shape3d::descriptors
