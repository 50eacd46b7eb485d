#include <stdexcept>
#include <string>

#include "describe.hpp"
#include "text.hpp"

namespace shape3d::descriptors::detail {
namespace {

SphericalImage image_of(const SphericalParameters& parameters, const Eigen::Ref<const Points>& V,
                        const Eigen::Ref<const Triangles>& F, const Eigen::Ref<const Points>& S,
                        int threads) {
  SphericalImageOptions options;
  options.size = parameters.size;
  options.sampling = parameters.sampling;
  options.threads = threads;
  switch (parameters.image) {
    case SphericalImageKind::sni:
      return spherical_normal_image(V, F, S, options);
    case SphericalImageKind::sci:
      return spherical_curvature_image(V, F, S, options);
    case SphericalImageKind::sgi:
      break;
  }
  return spherical_geometry_image(V, F, S, options);
}

Eigen::Index components_of(const SphericalParameters& parameters) {
  return parameters.image == SphericalImageKind::sci ? 1 : parameters.components;
}

}  // namespace

ShTransform prepare(const SphericalParameters& parameters) {
  require_between("components", parameters.components, 1, 3);
  if (parameters.form == SphericalForm::roots && parameters.image == SphericalImageKind::sci) {
    throw std::invalid_argument(
        "form is 'roots', which the one component of sci does not have, expected amplitudes or "
        "norms");
  }
  return ShTransform(parameters.size, parameters.K, parameters.route);
}

Eigen::Index length(const SphericalParameters& parameters) {
  const Eigen::Index degrees = parameters.K + 1;
  switch (parameters.form) {
    case SphericalForm::amplitudes:
      return components_of(parameters) * degrees * (degrees + 1) / 2;
    case SphericalForm::norms:
      return degrees;
    case SphericalForm::roots:
      break;
  }
  return 3 * degrees;
}

Eigen::VectorXd describe(const SphericalParameters& parameters, const ShTransform& transform,
                         const Eigen::Ref<const Points>& V, const Eigen::Ref<const Triangles>& F,
                         const Eigen::Ref<const Points>& S, int threads) {
  const Eigen::MatrixXcd coefficients = transform(image_of(parameters, V, F, S, threads).samples);
  switch (parameters.form) {
    case SphericalForm::amplitudes:
      return sh_amplitudes(coefficients.leftCols(components_of(parameters))).reshaped();
    case SphericalForm::norms:
      return sh_norms(coefficients);
    case SphericalForm::roots:
      break;
  }
  return sh_component_roots(coefficients);
}

}  // namespace shape3d::descriptors::detail
