#include "shape3d/descriptors/hsh.hpp"

#include <cmath>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "band_limited.hpp"
#include "meshes.hpp"
#include "shape3d/descriptors/hsh_sampling.hpp"
#include "shape3d/descriptors/voxelize.hpp"
#include "sphere_map.hpp"

namespace {
using namespace shape3d::descriptors;
using namespace shape3d::descriptors::test;
using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

double relative(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).norm() / b.norm();
}

Voxels empty_voxels(int side) {
  Voxels voxels;
  voxels.side = side;
  voxels.values.assign(static_cast<std::size_t>(side) * side * side, 0.0F);
  return voxels;
}

Vector3d centre_of(const Voxels& voxels, int i, int j, int k) {
  return Vector3d(2 * i + 1 - voxels.side, 2 * j + 1 - voxels.side, 2 * k + 1 - voxels.side) /
         voxels.side;
}

// The voxels turned by a rotation that maps the grid to itself.
Voxels turned(const Voxels& voxels, const Eigen::Matrix3d& rotation) {
  Voxels result = empty_voxels(voxels.side);
  for (int k = 0; k < voxels.side; ++k) {
    for (int j = 0; j < voxels.side; ++j) {
      for (int i = 0; i < voxels.side; ++i) {
        const Vector3d to = rotation * centre_of(voxels, i, j, k) * voxels.side +
                            Vector3d::Constant(voxels.side - 1);
        result.values[result.index(static_cast<int>(std::lround(to[0] / 2)),
                                   static_cast<int>(std::lround(to[1] / 2)),
                                   static_cast<int>(std::lround(to[2] / 2)))] = voxels.at(i, j, k);
      }
    }
  }
  return result;
}

Eigen::Matrix3d quarter_turn() {
  Eigen::Matrix3d turn;
  turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  return turn;
}

TEST_CASE("both sampling routes recover band-limited functions", "[descriptors][analytic]") {
  // separable: exact with K + 1 nodes; svd: the dissertation's 20 x 20 x 20 for K = 8.
  const auto [quadrature, K, n] =
      GENERATE(table<Quadrature, int, int>({{Quadrature::separable, 8, 9},
                                            {Quadrature::separable, 8, 13},
                                            {Quadrature::separable, 20, 21},
                                            {Quadrature::svd, 4, 10},
                                            {Quadrature::svd, 8, 20}}));
  INFO("K " << K << ", n " << n);
  const HshCoefficients truth = random_coefficients(K, 7);
  const HshSampling sampling(K, quadrature, n);
  Eigen::VectorXd values(sampling.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const Vector3d angles = sampling.node(i);
    values[i] = series(truth, angles[0], angles[1], angles[2]);
  }
  const Eigen::VectorXcd found = sampling.coefficients(values);
  CHECK((found - truth.values).cwiseAbs().maxCoeff() < 1e-10);
}

TEST_CASE("the energy of a function is the energy of its coefficients", "[descriptors][analytic]") {
  // Parseval: ∫ f² over S³ = Σ |C|²; f² has degree 2K, exact with enough nodes.
  const int K = 6, n = 14;
  const HshCoefficients truth = random_coefficients(K, 3);
  const HshSampling sampling(2 * K, Quadrature::separable, n);
  Eigen::VectorXd squares(sampling.size());
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    const Vector3d angles = sampling.node(i);
    squares[i] = std::pow(series(truth, angles[0], angles[1], angles[2]), 2);
  }
  // ∫ g = C_{0,0}^0 / Y_{0,0}^0, Y_{0,0}^0 = 1/√(2π²).
  const double integral = sampling.coefficients(squares)[0].real() * std::sqrt(2 * kPi * kPi);
  CHECK(integral == Approx(truth.values.squaredNorm()).epsilon(1e-12));
  CHECK(hsh_energies(truth).squaredNorm() == Approx(truth.values.squaredNorm()).epsilon(1e-13));
}

TEST_CASE("rotating a function changes neither energies nor Gram invariants",
          "[descriptors][property]") {
  // The rotated function is sampled anew at the nodes.
  const int K = 7;
  const HshCoefficients f = random_coefficients(K, 11);
  const HshSampling sampling(K, Quadrature::separable, K + 1);
  for (std::uint64_t r = 0; r < 3; ++r) {
    const Eigen::Matrix3d back = random_rotation(r).transpose();
    Eigen::VectorXd values(sampling.size());
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const Vector3d angles = sampling.node(i);
      const Vector3d at =
          back * Vector3d(std::sin(angles[1]) * std::cos(angles[2]),
                          std::sin(angles[1]) * std::sin(angles[2]), std::cos(angles[1]));
      values[i] =
          series(f, angles[0], std::acos(std::clamp(at[2], -1.0, 1.0)), std::atan2(at[1], at[0]));
    }
    HshCoefficients g = f;
    g.values = sampling.coefficients(values);
    CHECK((g.values - f.values).norm() > 0.5 * f.values.norm());
    CHECK(relative(hsh_energies(g), hsh_energies(f)) < 1e-12);
    CHECK(relative(gram_invariants(g), gram_invariants(f)) < 1e-12);
    CHECK(relative(gram_roots(g), gram_roots(f)) < 1e-6);  // roots of eigenvalues that are 0
  }
}

TEST_CASE("Gram invariants hold the energies on their diagonal", "[descriptors][property]") {
  CHECK(gram_count(15) == 816);
  const HshCoefficients f = random_coefficients(5, 2);
  const Eigen::VectorXd gram = gram_invariants(f), energies = hsh_energies(f);
  REQUIRE(gram.size() == static_cast<Eigen::Index>(gram_count(5)));
  Eigen::Index next = 0;
  for (int l = 0; l <= 5; ++l) {
    for (int a = l; a <= 5; ++a) {
      for (int b = a; b <= 5; ++b) {
        std::complex<double> product = 0;
        for (int m = -l; m <= l; ++m) product += f.at(a, l, m) * std::conj(f.at(b, l, m));
        CHECK(std::abs(product - gram[next]) < 1e-12);  // its imaginary part vanishes
        if (a == b) {
          const double energy = energies[static_cast<Eigen::Index>(hsh_pair_index(a, l))];
          CHECK(gram[next] == Approx(energy * energy).epsilon(1e-13));
        }
        ++next;
      }
    }
  }
}

TEST_CASE("Gram roots squared are the Gram matrices", "[descriptors][property]") {
  // Their squares have the trace of G, so the vector has the norm of the function; and they turn
  // with nothing, as a function of G alone.
  const HshCoefficients f = random_coefficients(6, 4);
  const Eigen::VectorXd roots = gram_roots(f), gram = gram_invariants(f);
  REQUIRE(roots.size() == static_cast<Eigen::Index>(gram_count(6)));
  CHECK(roots.norm() == Approx(f.values.norm()).epsilon(1e-12));
  Eigen::Index from = 0;
  for (int l = 0; l <= 6; ++l) {
    const Eigen::Index n = 7 - l;
    Eigen::MatrixXd root(n, n), square(n, n);
    for (Eigen::Index a = 0; a < n; ++a) {
      for (Eigen::Index b = a; b < n; ++b, ++from) {
        root(a, b) = root(b, a) = a == b ? roots[from] : roots[from] / std::sqrt(2.0);
        square(a, b) = square(b, a) = gram[from];
      }
    }
    CHECK((root * root - square).norm() < 1e-11 * square.norm());
  }
  CHECK(roots[roots.size() - 1] ==
        Approx(hsh_energies(f)[static_cast<Eigen::Index>(hsh_pair_index(6, 6))]));
}

TEST_CASE("the sum over voxels is the sum of the basis functions", "[descriptors][analytic]") {
  // Direct: every voxel times conj Y times its measure; the transform folds mirror images, groups
  // radii and runs recurrences over vectors. Values keep off the border of the ball.
  const int side = GENERATE(12, 13, 16);
  const auto map =
      GENERATE(SphereMap::two_sided, SphereMap::equal_volume, SphereMap::stereographic);
  HshOptions options;
  options.K = 5;
  options.map = map;
  options.stretch = 3;
  Voxels voxels = empty_voxels(side);
  Eigen::VectorXcd direct = Eigen::VectorXcd::Zero(static_cast<Eigen::Index>(hsh_count(5)));
  std::uint32_t state = 1;
  for (int k = 0; k < side; ++k) {
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        const Vector3d p = centre_of(voxels, i, j, k);
        if (p.norm() > 0.8) continue;
        state = state * 1664525U + 1013904223U;
        const float f = static_cast<float>(state >> 16) / 65536.0F;
        voxels.values[voxels.index(i, j, k)] = f;
        const double rho = p.norm(), edge = 2.0 / side;
        const double theta0 = hsh_angle(map, 3, rho);
        const double theta = rho > 0 ? std::acos(std::clamp(p[2] / rho, -1.0, 1.0)) : 0.0;
        const double measure =
            edge * edge * edge * detail::mean_density(map, 3, rho - edge / 2, rho + edge / 2);
        direct += f * measure * hsh_basis(5, theta0, theta, std::atan2(p[1], p[0])).conjugate();
        if (map == SphereMap::two_sided) {
          direct +=
              f * measure * hsh_basis(5, kPi - theta0, theta, std::atan2(p[1], p[0])).conjugate();
        }
      }
    }
  }
  const HshCoefficients found = HshTransform(options, side)(voxels, 1);
  const double worst = (found.values - direct).cwiseAbs().maxCoeff();
  INFO("side " << side << ", difference times 1e12: " << worst * 1e12);
  CHECK(worst < 1e-11);
  CHECK(HshTransform(options, side)(voxels, 2).values == found.values);
}

TEST_CASE("the maps to S3 have their measures", "[descriptors][analytic]") {
  for (const double rho : {0.0, 1e-8, 1e-3, 0.3, 0.79, 0.8, 0.999, 1.0}) {
    const double t = hsh_angle(SphereMap::equal_volume, 4, rho);
    CHECK(t - std::sin(t) * std::cos(t) ==
          Approx(kPi * rho * rho * rho).epsilon(1e-13).margin(1e-16));
    CHECK(std::abs(detail::ball_radius(SphereMap::equal_volume, 4, t) - rho) <= 1e-12 * rho);
    CHECK(std::sin(hsh_angle(SphereMap::two_sided, 4, rho)) == Approx(rho).epsilon(1e-15));
    CHECK(std::tan(hsh_angle(SphereMap::stereographic, 4, rho) / 2) == Approx(4 * rho));
  }
  // Whole balls: half of S³, all of it, and what 2 atan 4 bounds; |S³| = 2π².
  const double ball = 1.0 / 3;
  CHECK(detail::mean_density(SphereMap::two_sided, 1, 0, 1) * ball == Approx(kPi / 4));
  CHECK(detail::mean_density(SphereMap::equal_volume, 1, 0, 1) * ball == Approx(kPi / 2));
  const double end = 2 * std::atan(4.0);
  CHECK(detail::mean_density(SphereMap::stereographic, 4, 0, 1) * ball ==
        Approx((end - std::sin(end) * std::cos(end)) / 2));
}

TEST_CASE("two-sided harmonics of odd parity vanish", "[descriptors][analytic]") {
  // Tables 5.1 and 5.2: 20 of the 45 numbers, and 64 of 136 with K = 15.
  const Soup body = bumpy(12);
  const Voxels voxels = voxelize(body.V, body.F);
  for (const auto& [K, zeros] : {std::pair{8, 20}, std::pair{15, 64}}) {
    HshOptions options;
    options.K = K;
    options.map = SphereMap::two_sided;
    const Eigen::VectorXd energies = hsh_energies(HshTransform(options, 64)(voxels));
    int found = 0;
    for (int lambda = 0; lambda <= K; ++lambda) {
      for (int l = 0; l <= lambda; ++l) {
        const double energy = energies[static_cast<Eigen::Index>(hsh_pair_index(lambda, l))];
        if ((lambda - l) % 2 != 0) {
          CHECK(energy == 0.0);
          ++found;
        } else {
          CHECK(energy > 0.0);
        }
      }
    }
    CHECK(found == zeros);
    options.map = SphereMap::equal_volume;
    CHECK(hsh_energies(HshTransform(options, 64)(voxels)).minCoeff() > 1e-6);
  }
}

TEST_CASE("quarter turns of the voxels change nothing", "[descriptors][property]") {
  const Soup body = bumpy(8);
  const Voxels voxels = voxelize(body.V, body.F);
  Eigen::Matrix3d other;
  other << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  HshOptions options;
  options.K = 10;
  const HshTransform transform(options, 64);
  const HshCoefficients f = transform(voxels);
  for (const Eigen::Matrix3d& turn : {quarter_turn(), other}) {
    const HshCoefficients g = transform(turned(voxels, turn));
    CHECK((g.values - f.values).norm() > 0.1 * f.values.norm());
    CHECK(relative(hsh_energies(g), hsh_energies(f)) < 1e-13);
    CHECK(relative(gram_invariants(g), gram_invariants(f)) < 1e-13);
  }
}

TEST_CASE("quadratures of the same voxels agree", "[descriptors][property]") {
  // Different sampling of one smooth volume: within what trilinear interpolation changes it.
  const Soup body = bumpy(8);
  const Voxels voxels = voxelize(body.V, body.F);
  HshOptions options;
  options.K = 6;
  options.map = GENERATE(SphereMap::equal_volume, SphereMap::stereographic);
  options.stretch = 2;
  const Eigen::VectorXd sum = hsh_energies(HshTransform(options, 64)(voxels));
  options.quadrature = Quadrature::separable;
  CHECK(relative(hsh_energies(HshTransform(options, 64)(voxels)), sum) < 0.02);
  options.quadrature = Quadrature::svd;
  // A fit with equal weights at equal angles: of what is beyond K another part is taken for it.
  CHECK(relative(hsh_energies(HshTransform(options, 64)(voxels)), sum) < 0.25);
}

TEST_CASE("surface points give what fine area voxels tend to", "[descriptors][property]") {
  const Soup body = bumpy(10);
  const Frame frame = surface_frame(body.V, body.F);
  HshOptions options;
  options.K = 6;
  const SurfacePoints points = surface_points(body.V, body.F, frame.radius / 64);
  const Eigen::VectorXd exact = hsh_energies(hsh_of_points(points, frame, options));
  double previous = 1;
  for (const int side : {32, 64, 128}) {
    VoxelizeOptions voxels;
    voxels.side = side;
    voxels.fill = Fill::area;
    // A voxel holds the area in voxel edges squared; its measure is 3π/2 of its volume.
    const Eigen::VectorXd found =
        hsh_energies(HshTransform(options, side)(voxelize(body.V, body.F, voxels))) /
        (1.5 * kPi * 2 / side);
    const double error = relative(found, exact);
    INFO("side " << side << ", error " << error);
    CHECK(error < previous / 3);  // second order: the tent widens the surface by its variance
    previous = error;
  }
  CHECK(previous < 0.005);
  const Soup moved = transformed(body, random_rotation(5), Vector3d(3, -1, 2));
  const Frame moved_frame = surface_frame(moved.V, moved.F);
  const HshCoefficients turned_points = hsh_of_points(
      surface_points(moved.V, moved.F, moved_frame.radius / 64), moved_frame, options, 1);
  CHECK(relative(hsh_energies(turned_points), exact) < 1e-11);
  CHECK(hsh_of_points(surface_points(moved.V, moved.F, moved_frame.radius / 64), moved_frame,
                      options, 3)
            .values == turned_points.values);
  options.map = SphereMap::two_sided;
  const Eigen::VectorXd two_sided = hsh_energies(hsh_of_points(points, frame, options));
  CHECK(two_sided[static_cast<Eigen::Index>(hsh_pair_index(1, 0))] == 0.0);
}

TEST_CASE("reconstruction approaches the voxels as K grows", "[descriptors][analytic]") {
  const Soup body = bumpy(8);
  VoxelizeOptions voxel_options;
  voxel_options.side = 48;
  const Voxels voxels = voxelize(body.V, body.F, voxel_options);
  double previous = 1;
  for (const int K : {2, 5, 10, 20}) {
    HshOptions options;
    options.K = K;
    const double residual = hsh_residual(HshTransform(options, 48)(voxels), voxels);
    INFO("K " << K << ", residual " << residual);
    CHECK(residual < previous);
    previous = residual;
  }
  CHECK(previous < 0.1);
  CHECK(hsh_residual(random_coefficients(2, 1), empty_voxels(16)) == 0.0);

  // A band-limited volume comes back, to the accuracy of the sum over voxels as a quadrature.
  const HshCoefficients truth = random_coefficients(3, 5);
  HshOptions options;
  options.K = 3;
  const auto error = [&](int side) {
    const HshCoefficients found = HshTransform(options, side)(reconstruct(truth, side));
    return (found.values - truth.values).norm() / truth.values.norm();
  };
  const double coarse = error(32), fine = error(128);
  INFO("error " << coarse << " at 32, " << fine << " at 128");
  CHECK(coarse < 0.1);
  CHECK(fine < coarse / 3);
  const Voxels band = reconstruct(truth, 64);
  CHECK(hsh_residual(truth, band) < 1e-6);  // voxels are single precision
  const Vector3d p = centre_of(band, 20, 45, 30);
  CHECK(band.at(20, 45, 30) == Approx(series(truth, hsh_angle(SphereMap::equal_volume, 4, p.norm()),
                                             std::acos(p[2] / p.norm()), std::atan2(p[1], p[0])))
                                   .epsilon(1e-5));
}

TEST_CASE("wrong options of the transform are refused", "[descriptors][contract]") {
  HshOptions options;
  options.K = 32;
  CHECK_THROWS_WITH(HshTransform(options, 64),
                    "K is 32, expected 0 … 31 for 64 voxels along an axis");
  options.K = 61;
  CHECK_THROWS_WITH(HshTransform(options, 256), "K is 61, expected 0 … 60");
  options.K = 4;
  CHECK_THROWS_WITH(HshTransform(options, 7), "side is 7, expected 8 … 256");
  CHECK_THROWS_WITH(HshTransform(options, 257), "side is 257, expected 8 … 256");
  options.map = SphereMap::stereographic;
  options.stretch = 0;
  CHECK_THROWS_WITH(HshTransform(options, 64), "stretch is 0, expected 0.1 … 100");
  CHECK_THROWS_WITH(hsh_angle(SphereMap::stereographic, 1000, 0.5),
                    "stretch is 1000, expected 0.1 … 100");
  CHECK_THROWS_WITH(hsh_angle(SphereMap::two_sided, 1, 1.5), "rho is 1.5, expected 0 … 1");
  CHECK_THROWS_WITH(HshSampling(4, Quadrature::separable, 4), "grid is 4, expected 5 … 512");
  CHECK_THROWS_WITH(HshSampling(4, Quadrature::svd, 41), "grid is 41, expected 10 … 40");
  CHECK_THROWS_WITH(HshSampling(4, Quadrature::voxels, 20),
                    "quadrature is voxels, expected separable or svd");
  CHECK_THROWS_WITH(HshSampling(1, Quadrature::separable, 2).coefficients(Eigen::VectorXd(3)),
                    "values has 3 numbers, expected 16");
  const HshTransform transform(HshOptions{}, 64);
  CHECK_THROWS_WITH(transform(empty_voxels(32)), "the voxels have side 32, expected 64");
  Voxels cut = empty_voxels(64);
  cut.values.pop_back();
  CHECK_THROWS_WITH(transform(cut), "the voxels have 262143 values, expected 262144");
  CHECK_THROWS_WITH(transform(empty_voxels(64), -2),
                    "threads is -2, expected 0 for all processors, or more");
  SurfacePoints points;
  points.points = Points::Zero(3, 3);
  points.weights = Eigen::VectorXd::Ones(2);
  CHECK_THROWS_WITH(hsh_of_points(points, Frame{}, HshOptions{}),
                    "weights has 2 numbers, expected 3, one a point");
  HshCoefficients wrong = random_coefficients(3, 1);
  wrong.K = 4;
  CHECK_THROWS_WITH(reconstruct(wrong, 16), "the coefficients are 30, expected 55 for K = 4");
  CHECK_THROWS_WITH(hsh_residual(wrong, empty_voxels(16)),
                    "the coefficients are 30, expected 55 for K = 4");
}

}  // namespace
