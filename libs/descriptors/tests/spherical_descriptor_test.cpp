#include <stdexcept>

#include <catch2/catch.hpp>

#include "meshes.hpp"
#include "shape3d/descriptors/descriptor.hpp"

namespace {
using namespace shape3d::descriptors;
using namespace shape3d::descriptors::test;
using Catch::Matchers::Contains;
using Catch::Matchers::Message;

TEST_CASE("vectors of spherical images are what their parts give", "[descriptors]") {
  const Soup mesh = bumpy(12);
  const Points S = mesh.V.rowwise().normalized();
  SphericalImageOptions options;
  options.size = 32;
  const auto coefficients = [&](const SphericalImage& image, int K) {
    return ShTransform(32, K)(image.samples);
  };
  const Eigen::MatrixXcd sni = coefficients(spherical_normal_image(mesh.V, mesh.F, S, options), 5);
  const Eigen::MatrixXcd sgi =
      coefficients(spherical_geometry_image(mesh.V, mesh.F, S, options), 5);
  const Eigen::MatrixXcd sci =
      coefficients(spherical_curvature_image(mesh.V, mesh.F, S, options), 5);
  const auto vector_of = [&](const std::string& spec) {
    const Descriptor descriptor = Descriptor::parse(spec);
    const Eigen::VectorXd vector = descriptor.compute(mesh.V, mesh.F, S);
    INFO(spec);
    CHECK(vector.size() == descriptor.length());
    return vector;
  };
  CHECK(vector_of("sni:K=5,size=32") == sh_norms(sni));
  CHECK(vector_of("sgi:K=5,size=32,form=norms") == sh_norms(sgi));
  CHECK(vector_of("sci:K=5,size=32") == sh_norms(sci));
  CHECK(vector_of("sni:K=5,size=32,form=roots") == sh_component_roots(sni));
  // The dissertation's (K + 2)(K + 1) numbers, and those of three components.
  const Eigen::VectorXd two = vector_of("sni:K=5,size=32,form=amplitudes");
  REQUIRE(two.size() == 7 * 6);
  CHECK(two.head(21) == sh_amplitudes(sni).col(0));
  CHECK(two.tail(21) == sh_amplitudes(sni).col(1));
  CHECK(vector_of("sgi:K=5,size=32,form=amplitudes,components=3").size() == 3 * 21);
  CHECK(vector_of("sni:K=5,size=32,form=amplitudes,components=1").size() == 21);
  CHECK(vector_of("sci:K=5,size=32,form=amplitudes") == sh_amplitudes(sci));
  CHECK(Descriptor::parse("sni:K=16,form=amplitudes").length() == 18 * 17);
  // Routes differ where an image is not band-limited, a little.
  const Eigen::VectorXd fft = vector_of("sni:K=5,size=32"),
                        sum = vector_of("sni:K=5,size=32,route=quadrature"),
                        fit = vector_of("sni:K=5,size=32,route=svd");
  CHECK((fft - sum).norm() < 1e-13 * fft.norm());
  CHECK((fft - fit).norm() < 0.02 * fft.norm());
  CHECK((fft - fit).norm() > 1e-8 * fft.norm());
  CHECK(vector_of("sni:K=5,size=32,sampling=point") != fft);
}

TEST_CASE("the text of spherical kinds", "[descriptors]") {
  const Descriptor descriptor =
      Descriptor::parse("sgi:route=svd,sampling=point,components=3,form=amplitudes,size=16,K=3");
  CHECK(descriptor.to_string() ==
        "sgi:K=3,size=16,form=amplitudes,components=3,sampling=point,route=svd,align=none");
  CHECK_FALSE(Descriptor::parse(descriptor.to_string()).difference(descriptor));
  CHECK(Descriptor::parse("sni:K=3").difference(Descriptor::parse("sni:K=3,form=roots")) ==
        "form is norms in one and roots in the other");
}

TEST_CASE("spherical kinds refuse their parameters", "[descriptors][contract]") {
  const auto refuses = [](const std::string& spec, const std::string& sentence) {
    CHECK_THROWS_MATCHES(Descriptor::parse(spec), std::invalid_argument, Message(sentence));
  };
  refuses("sni:K=32", "K is 32, expected 0 … 31, the bandwidth of 64 rows");
  refuses("sni:size=63", "size is 63, expected an even number of rows");
  refuses("sci:form=roots",
          "form is 'roots', which the one component of sci does not have, expected amplitudes or "
          "norms");
  CHECK_THROWS_WITH(Descriptor::parse("sni:components=4"), Contains("components is 4, expected 1"));
  CHECK_THROWS_WITH(Descriptor::parse("sni:route=fast"),
                    Contains("route is 'fast', expected quadrature, fft or svd"));
  const Soup mesh = bumpy(4);
  Points S = mesh.V.rowwise().normalized();
  S.row(0) = -S.row(0);
  CHECK_THROWS_WITH(Descriptor::parse("sni").compute(mesh.V, mesh.F, S),
                    Contains("triangles are flipped"));
}

}  // namespace
