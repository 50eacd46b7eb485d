#include <stdexcept>

#include "describe.hpp"
#include "text.hpp"

namespace shape3d::descriptors::detail {

Eigen::Index length(const SphericalParameters& parameters) {
  require_between("K", parameters.K, 0, 1000);
  return static_cast<Eigen::Index>(parameters.K + 1) * (parameters.K + 2);
}

Eigen::VectorXd describe(const SphericalParameters&, const Eigen::Ref<const Points>&,
                         const Eigen::Ref<const Triangles>&, const Eigen::Ref<const Points>&, int) {
  throw std::invalid_argument("spherical images are not part of this build");
}

}  // namespace shape3d::descriptors::detail
