#include "shape3d/descriptors/panorama.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "meshes.hpp"
#include "shape3d/descriptors/descriptor.hpp"

namespace {
using namespace shape3d::descriptors;
using namespace shape3d::descriptors::test;
using Eigen::Vector3d;

// A box of three different edges; the unit of the images is the RMS distance of its surface.
struct Box {
  Vector3d half{1.0, 0.6, 0.3};
  Soup soup = box(-half, half);
  double unit = surface_frame(soup.V, soup.F, Centre::area, Scale::rms, 1.0).radius;
};

TEST_CASE("panoramic views of a box are distances of its sides", "[descriptors][analytic]") {
  const Box b;
  PanoramaOptions options;
  const PanoramaImages images = panorama_images(b.soup.V, b.soup.F, options);
  const int rows = options.size, columns = 2 * options.size;
  // About the longest axis: within the box's length a pixel at angle φ sees the sides y = ±0.6,
  // z = ±0.3 at min(0.6/|cos φ|, 0.3/|sin φ|), where e.g. n·e is |cos φ|.
  const double pixel_angle = 2.0 * M_PI / columns;
  int seen = 0, empty = 0;
  for (int row = 0; row < rows; ++row) {
    const double low = (2.0 * row / rows - 1.0) * 2.0 * b.unit,
                 high = (2.0 * (row + 1) / rows - 1.0) * 2.0 * b.unit;
    for (int column = 0; column < columns; ++column) {
      const double found = images.distance[0](row, column) * b.unit;
      if (low > b.half[0] || high < -b.half[0]) {
        CHECK(found == 0.0);
        continue;
      }
      if (low < -b.half[0] + 0.1 || high > b.half[0] - 0.1) continue;
      // The outermost point of the pixel lies between the extremes over its angles.
      double least = 1e9, most = 0.0;
      for (int k = 0; k <= 8; ++k) {
        const double phi = -M_PI + (column + k / 8.0) * pixel_angle;
        const double r = std::min(b.half[1] / std::max(1e-12, std::abs(std::cos(phi))),
                                  b.half[2] / std::max(1e-12, std::abs(std::sin(phi))));
        least = std::min(least, r);
        most = std::max(most, r);
      }
      INFO("row " << row << ", column " << column);
      ++seen;
      if (found == 0.0) {
        ++empty;
        continue;
      }
      CHECK(found > least - 1e-9);
      CHECK(found < most + 1e-4);
    }
  }
  CHECK(seen > 1000);
  CHECK(empty < 0.06 * seen);  // between samples
  // Square on at the middle of a side: y = 0.6 at φ = 0.
  CHECK(images.facing[0](rows / 2, columns / 2) == Approx(1.0).epsilon(0.01));
}

TEST_CASE("panoramic spectra do not change with pose, size, mirroring, order and threads",
          "[descriptors][property]") {
  const Soup body = joined(bumpy(24), box({1.5, -0.1, -0.1}, {2.5, 0.1, 0.2}));
  const Soup stretched = transformed(body, Vector3d(1.6, 1.0, 0.7).asDiagonal());
  for (const PanoramaAxes axes : {PanoramaAxes::surface, PanoramaAxes::normals}) {
    PanoramaOptions options;
    options.axes = axes;
    const Eigen::VectorXd spectrum = panorama_spectrum(stretched.V, stretched.F, options);
    REQUIRE(spectrum.size() == panorama_length(options));
    for (int n = 0; n < 3; ++n) {
      Eigen::Matrix3d linear = 37.0 * random_rotation(static_cast<std::uint64_t>(n));
      if (n == 1) linear *= -1.0;  // mirrored
      Soup moved = transformed(stretched, linear, Vector3d(10, -20, 5));
      if (n == 2) moved.F = moved.F.colwise().reverse().eval();
      const Eigen::VectorXd again = panorama_spectrum(moved.V, moved.F, options);
      // Axes turn about by whole pixels of rounding at most: samples on the border of a pixel.
      CHECK((again - spectrum).norm() < 0.01 * spectrum.norm());
    }
    CHECK(panorama_spectrum(stretched.V, stretched.F, options, 1) ==
          panorama_spectrum(stretched.V, stretched.F, options, 3));
  }
}

TEST_CASE("panoramic spectra are Fourier amplitudes of the images", "[descriptors]") {
  const Box b;
  PanoramaOptions options;
  options.K = 3;
  options.size = 16;
  const PanoramaImages images = panorama_images(b.soup.V, b.soup.F, options);
  const Eigen::VectorXd spectrum = panorama_spectrum(b.soup.V, b.soup.F, options);
  REQUIRE(spectrum.size() == 96);
  Eigen::Index place = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const Eigen::MatrixXd* image : {&images.distance[axis], &images.facing[axis]}) {
      for (int u = 0; u <= 3; ++u) {
        for (int v = 0; v <= 3; ++v) {
          double sum = 0.0;
          for (const int sign : {1, -1}) {
            std::complex<double> f = 0.0;
            for (int r = 0; r < 16; ++r) {
              for (int c = 0; c < 32; ++c) {
                f += (*image)(r, c) *
                     std::polar(1.0, -2.0 * M_PI * (sign * u * r / 16.0 + v * c / 32.0));
              }
            }
            sum += 0.5 * std::norm(f);
          }
          CHECK(spectrum[place++] == Approx(std::sqrt(sum) / 512.0).margin(1e-12));
        }
      }
    }
  }
}

TEST_CASE("panorama is a kind of descriptor with options that are checked", "[descriptors]") {
  const Box b;
  const Descriptor descriptor = Descriptor::parse("panorama:axes=normals,K=5");
  CHECK(descriptor.to_string() ==
        "panorama:axes=normals,K=5,size=64,power=0.5,unit=yes,align=none");
  CHECK(descriptor.length() == 216);
  const Eigen::VectorXd vector = descriptor.compute(b.soup.V, b.soup.F);
  CHECK(vector.norm() == Approx(1.0));
  PanoramaOptions options = std::get<PanoramaParameters>(descriptor.parameters()).options;
  const Eigen::VectorXd roots = panorama_spectrum(b.soup.V, b.soup.F, options).cwiseSqrt();
  CHECK((vector - roots / roots.norm()).norm() < 1e-12);
  options.size = 4;
  CHECK_THROWS_WITH(panorama_images(b.soup.V, b.soup.F, options), "size is 4, expected 8 … 512");
  options.size = 16;
  options.K = 8;
  CHECK_THROWS_WITH(panorama_spectrum(b.soup.V, b.soup.F, options), "K is 8, expected 0 … 7");
  CHECK_THROWS_WITH(panorama_length(options), "K is 8, expected 0 … 7");
  CHECK_THROWS_WITH(Descriptor::parse("panorama:power=2"), "power is 2, expected 0.1 … 1");
}

}  // namespace
