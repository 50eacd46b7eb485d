#include "shape3d/descriptors/csm.hpp"

#include <cmath>
#include <functional>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "shape3d/descriptors/hsh.hpp"

namespace {
using namespace shape3d::descriptors;
using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

Voxels sampled(int side, const std::function<double(const Vector3d&)>& f) {
  Voxels voxels;
  voxels.side = side;
  for (int k = 0; k < side; ++k) {
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        const Vector3d p(2 * i + 1 - side, 2 * j + 1 - side, 2 * k + 1 - side);
        voxels.values.push_back(static_cast<float>(f(p / side)));
      }
    }
  }
  return voxels;
}

TEST_CASE("concentric spheres give the norms of functions on spheres", "[descriptors][analytic]") {
  // f = 3 + x/ρ + 2 (3z² − ρ²)/ρ² on every sphere: ‖f_0‖ = 3 √4π, ‖f_1‖ = √(4π/3),
  // ‖f_2‖ = 2 √(16π/5).
  const Voxels voxels = sampled(64, [](const Vector3d& p) {
    const double r = p.norm();
    return 3 + p[0] / r + 2 * (3 * p[2] * p[2] / (r * r) - 1);
  });
  const double expected[4] = {3 * std::sqrt(4 * kPi), std::sqrt(4 * kPi / 3),
                              2 * std::sqrt(16 * kPi / 5), 0};
  CsmOptions options;
  options.R = 5;
  options.K = 3;
  const Eigen::VectorXd shells = ConcentricSpheres(options, 64)(voxels);
  REQUIRE(shells.size() == 20);
  for (int r = 0; r < 5; ++r) {
    for (int l = 0; l <= 3; ++l) {
      INFO("shell " << r << ", l " << l);
      CHECK(std::abs(shells[4 * r + l] - expected[l]) < (r == 0 ? 0.3 : 0.02));
    }
  }
  options.variant = CsmVariant::kazhdan;
  const Eigen::VectorXd spheres = ConcentricSpheres(options, 64)(voxels);
  REQUIRE(spheres.size() == csm_length(options));
  REQUIRE(spheres.size() == 25);
  for (int r = 1; r < 5; ++r) {
    const double radius = (r + 0.5) / 5;
    // The three numbers of the quadratic form have the norm of f_0 + f_2.
    CHECK(spheres.segment(5 * r, 3).norm() ==
          Approx(radius * std::hypot(expected[0], expected[2])).epsilon(0.01));
    CHECK(spheres[5 * r + 3] == Approx(radius * expected[1]).epsilon(0.01));
    CHECK(spheres[5 * r + 4] < 0.02);
  }
}

TEST_CASE("the quadratic form is described by its eigenvalues", "[descriptors][analytic]") {
  // x'Ax/ρ² for two forms A, B: the distance of their triples is that of the functions once both
  // are turned into their axes, ∫ (Σ d_i x_i²)² = 4π/15 (2 Σ d_i² + (Σ d_i)²).
  Eigen::Matrix3d A, B;
  A << 2, 0.4, -0.3, 0.4, 1, 0.6, -0.3, 0.6, -0.5;
  B << 1, -0.7, 0.2, -0.7, 1.5, 0.1, 0.2, 0.1, 0.3;
  CsmOptions options;
  options.variant = CsmVariant::kazhdan;
  options.R = 2;
  options.K = 2;
  const ConcentricSpheres spheres(options, 64);
  const auto triple = [&](const Eigen::Matrix3d& form) -> Vector3d {
    const Voxels voxels =
        sampled(64, [&](const Vector3d& p) -> double { return p.dot(form * p) / p.squaredNorm(); });
    return spheres(voxels).segment(4, 3) / 0.75;  // the sphere of radius 3/4
  };
  const auto eigenvalues = [](const Eigen::Matrix3d& form) -> Vector3d {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(form).eigenvalues().reverse();
  };
  const Vector3d d = eigenvalues(A) - eigenvalues(B);
  const double expected = std::sqrt(4 * kPi / 15 * (2 * d.squaredNorm() + d.sum() * d.sum()));
  CHECK((triple(A) - triple(B)).norm() == Approx(expected).epsilon(0.01));
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized()).matrix();
  CHECK((triple(turn * A * turn.transpose()) - triple(A)).norm() < 0.01 * triple(A).norm());
}

// Fig. 5.4: the inner part of a binary volume turned by 90° about z, the outer part kept.
Voxels inner_and_outer(bool turned, bool outer_turned = false) {
  return sampled(64, [&](const Vector3d& at) {
    Vector3d p = at;
    if (at.norm() < 0.5 ? turned : outer_turned) p = Vector3d(at[1], -at[0], at[2]);
    const double r = p.norm();
    const bool bar = std::abs(p[1]) < 0.15 && std::abs(p[2]) < 0.1;
    const bool fin = p[0] > 0 && std::abs(p[1]) < 0.05 && p[2] > 0 && p[2] < 0.3;
    // Nothing within a voxel of the radius between: the parts stand on different shells.
    return (r < 0.45 || r > 0.55) && r < 0.95 && (bar || fin) ? 1.0 : 0.0;
  });
}

TEST_CASE("concentric spheres miss that inner parts turn and hyperspherical harmonics see it",
          "[descriptors][analytic]") {
  const Voxels before = inner_and_outer(false), after = inner_and_outer(true);
  CHECK(before.values != after.values);
  const auto change = [](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return (a - b).norm() / a.norm();
  };
  for (const CsmVariant variant : {CsmVariant::shells, CsmVariant::kazhdan}) {
    CsmOptions options;
    options.variant = variant;
    options.R = 32;
    options.K = 15;
    const ConcentricSpheres spheres(options, 64);
    CHECK(change(spheres(before), spheres(after)) < 1e-6);
  }
  CsmOptions coarse;  // five shells: 0.45 … 0.55 lies within the third, which mixes both parts
  coarse.R = 4;       // four: between the second and the third
  CHECK(change(ConcentricSpheres(coarse, 64)(before), ConcentricSpheres(coarse, 64)(after)) < 1e-6);
  for (const SphereMap map :
       {SphereMap::two_sided, SphereMap::equal_volume, SphereMap::stereographic}) {
    HshOptions options;
    options.map = map;
    options.K = 8;
    const HshTransform transform(options, 64);
    const HshCoefficients a = transform(before), b = transform(after);
    CHECK(change(hsh_energies(a), hsh_energies(b)) > 0.02);
    CHECK(change(gram_invariants(a), gram_invariants(b)) > 0.02);
    // Turning both is a rotation of the whole.
    const HshCoefficients whole = transform(inner_and_outer(true, true));
    CHECK(change(hsh_energies(a), hsh_energies(whole)) < 1e-12);
    CHECK(change(gram_invariants(a), gram_invariants(whole)) < 1e-12);
  }
}

TEST_CASE("concentric spheres do not depend on the number of threads", "[descriptors][property]") {
  const Voxels voxels = inner_and_outer(true);
  for (const CsmVariant variant : {CsmVariant::shells, CsmVariant::kazhdan}) {
    CsmOptions options;
    options.variant = variant;
    options.R = 9;
    options.K = 4;
    const ConcentricSpheres spheres(options, 64);
    CHECK(spheres(voxels, 1) == spheres(voxels, 3));
  }
}

TEST_CASE("wrong options of concentric spheres are refused", "[descriptors][contract]") {
  CsmOptions options;
  options.R = 33;
  CHECK_THROWS_WITH(ConcentricSpheres(options, 64), "R is 33, expected 1 … 32");
  options.R = 0;
  CHECK_THROWS_WITH(ConcentricSpheres(options, 64), "R is 0, expected 1 … 32");
  options.R = 4;
  options.K = 40;
  CHECK_THROWS_WITH(ConcentricSpheres(options, 64),
                    "K is 40, expected 0 … 31 for 64 voxels along an axis");
  options.K = 3;
  CHECK_THROWS_WITH(ConcentricSpheres(options, 1000), "side is 1000, expected 8 … 256");
  const ConcentricSpheres spheres(options, 64);
  CHECK_THROWS_WITH(spheres(sampled(16, [](const Vector3d&) { return 1.0; })),
                    "the voxels have side 16, expected 64");
  CHECK_THROWS_WITH(spheres(inner_and_outer(false), -3),
                    "threads is -3, expected 0 for all processors, or more");
  CHECK(csm_length(options) == 16);
  options.variant = CsmVariant::kazhdan;
  CHECK(csm_length(options) == 20);
  options.K = 1;
  CHECK(csm_length(options) == 8);
}

}  // namespace
