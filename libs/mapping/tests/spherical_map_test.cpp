#include "shape3d/mapping/spherical_map.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <future>
#include <numeric>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "support/closed_meshes.hpp"

namespace {
using namespace shape3d::mapping;
using namespace shape3d::test;

SphericalMap tight(const ClosedMesh& mesh, Energy energy = Energy::conformal) {
  SphericalMapOptions options;
  options.energy = energy;
  options.function_tolerance = 1e-12;
  return spherical_map(mesh.V, mesh.F, options);
}

double largest_distance(const Points& A, const Points& B) {
  return (A - B).rowwise().norm().maxCoeff();
}

double mean_square(const Points& A, const Points& B) {
  return std::sqrt((A - B).rowwise().squaredNorm().mean());
}

Eigen::Matrix3d some_rotation() {
  return Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).matrix();
}

TEST_CASE("the map of a sphere is the sphere as it lies") {
  // Without the refinement the vertices that fix the gauge lie where the linear map put them, which
  // is off by the error of the discretisation: the rest is that error times that of Möbius maps of
  // triangles.
  const Energy energy = GENERATE(Energy::conformal, Energy::harmonic);
  double previous = 1;
  for (const int levels : {2, 3, 4}) {
    const ClosedMesh mesh = icosphere(levels);
    SphericalMapOptions options;
    options.energy = energy;
    options.refine_angles = false;
    options.function_tolerance = 1e-12;
    const SphericalMap map = spherical_map(mesh.V, mesh.F, options);
    REQUIRE(map.status == Status::certified);
    const double error = largest_distance(map.S, mesh.V);
    INFO("levels = " << levels << ", error = " << error);
    CHECK(error < 2e-3);
    CHECK(error < previous / 4);
    CHECK(map.distortion.angle_change.max < 0.2);
    CHECK(map.minimisation.final_cost < 1e-4 * map.minimisation.initial_cost);
    previous = error;
  }
  CHECK(previous < 2e-5);
}

TEST_CASE("the refined map of a sphere is the sphere, however coarse") {
  for (const int levels : {1, 2, 3, 4}) {
    const ClosedMesh mesh = icosphere(levels);
    const SphericalMap map = tight(mesh);
    REQUIRE(map.status == Status::certified);
    const double error = largest_distance(map.S, mesh.V);
    INFO("levels = " << levels << ", error = " << error);
    CHECK(error < 1e-8);
    CHECK(map.distortion.angle_change.max < 1e-6);
    CHECK(map.refinement.used);
    CHECK(map.refinement.final_cost < 1e-6 * map.refinement.initial_cost);
  }
}

TEST_CASE("refinement lowers the mean change of angles") {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const ClosedMesh mesh = seed == 1 ? star_shaped(4, seed) : spharm_body(4, seed, 0.8);
    SphericalMapOptions options;
    const SphericalMap refined = spherical_map(mesh.V, mesh.F, options);
    options.refine_angles = false;
    const SphericalMap conformal = spherical_map(mesh.V, mesh.F, options);
    REQUIRE(refined.status == Status::certified);
    REQUIRE(conformal.status == Status::certified);
    CHECK_FALSE(conformal.refinement.used);
    CHECK(refined.refinement.final_cost < refined.refinement.initial_cost);
    CHECK(refined.distortion.angle_change.mean < 0.995 * conformal.distortion.angle_change.mean);
  }
}

TEST_CASE("the map of a turned sphere in a pose is that rotation") {
  const ClosedMesh mesh = icosphere(3);
  SphericalMapOptions options;
  options.function_tolerance = 1e-12;
  options.pose = some_rotation();
  const SphericalMap map = spherical_map(mesh.V, mesh.F, options);
  REQUIRE(map.status == Status::certified);
  CHECK(largest_distance(map.S, mesh.V * some_rotation().transpose()) < 1e-8);
}

/// exp of the integral of ds / r along a meridian from the equator of the spheroid
/// (cos u cos λ, cos u sin λ, c sin u), in closed form: geodesy's conformal latitude χ,
/// tan(π/4 + χ/2) = tan(π/4 + φ/2) ((1 − e sin φ) / (1 + e sin φ))^(e/2), with e² = 1 − c² (for c >
/// 1 e is imaginary, and the second factor exp(|e| atan(|e| sin φ))); φ is the geodetic latitude.
double conformal_latitude_sine(double sine_u, double c) {
  const double cosine_u = std::sqrt(std::max(0.0, 1 - sine_u * sine_u));
  if (cosine_u == 0) return sine_u;
  // The normal is (cos u, sin u / c) before scaling.
  const double sine_phi = (sine_u / c) / std::hypot(cosine_u, sine_u / c);
  const double square = 1 - c * c, e = std::sqrt(std::abs(square));
  const double correction =
      square > 0 ? -e * std::atanh(e * sine_phi) : e * std::atan(e * sine_phi);
  return std::tanh(std::atanh(sine_phi) + correction);
}

TEST_CASE("the map of a spheroid converges to its conformal latitude, second order in the edge") {
  const double c = GENERATE(0.5, 2.0);
  double previous = 0;
  for (const int levels : {2, 3, 4}) {
    ClosedMesh mesh = icosphere(levels);
    Points exact = mesh.V;
    for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
      const double x = mesh.V(i, 0), y = mesh.V(i, 1), z = mesh.V(i, 2);
      const double sine = conformal_latitude_sine(z, c), r = std::hypot(x, y);
      const double shrink = r > 0 ? std::sqrt(std::max(0.0, 1 - sine * sine)) / r : 0;
      exact.row(i) << shrink * x, shrink * y, sine;
      mesh.V(i, 2) = c * z;
    }
    const SphericalMap map = tight(mesh);
    REQUIRE(map.status == Status::certified);
    const double error = mean_square(map.S, exact);
    INFO("c = " << c << ", levels = " << levels << ", error = " << error);
    if (previous > 0) CHECK(error < previous / 3.2);
    previous = error;
  }
  CHECK(previous < 4e-3);
}

/// The sphere moved by z → scale · z in stereographic coordinates about `axis`: a Möbius map.
Points moebius(const Points& S, const Eigen::Vector3d& axis, double scale) {
  const Eigen::Matrix3d R =
      Eigen::Quaterniond::FromTwoVectors(axis, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Points T = S * R.transpose();
  for (Eigen::Index i = 0; i < T.rows(); ++i) {
    const double x = T(i, 0), y = T(i, 1), z = T(i, 2);
    const double a = 1 + z, b = scale * scale * (1 - z);
    T.row(i) << 2 * scale * x / (a + b), 2 * scale * y / (a + b), (a - b) / (a + b);
  }
  return T * R;
}

TEST_CASE("a sphere of uneven triangles, pre-warped by a Moebius map, converges to itself") {
  double previous = 0;
  for (const int levels : {2, 3, 4}) {
    ClosedMesh mesh = icosphere(levels);
    mesh.V = moebius(mesh.V, Eigen::Vector3d(0.3, 0.5, -1).normalized(), 2.5);
    const SphericalMap map = tight(mesh);
    REQUIRE(map.status == Status::certified);
    const double error = largest_distance(map.S, mesh.V);
    INFO("levels = " << levels << ", error = " << error);
    if (previous > 0) CHECK(error < previous / 3);
    previous = error;
  }
}

/// Cross-ratio of four points of the sphere in stereographic coordinates.
std::complex<double> cross_ratio(const Points& S, const std::array<int, 4>& at) {
  std::array<std::complex<double>, 4> z;
  for (int k = 0; k < 4; ++k) {
    z[k] = std::complex<double>(S(at[k], 0), S(at[k], 1)) / (1.0 - S(at[k], 2));
  }
  return (z[0] - z[2]) * (z[1] - z[3]) / ((z[0] - z[3]) * (z[1] - z[2]));
}

TEST_CASE("mapping after a Moebius map of the target gives the same map up to a Moebius map") {
  // M → S is conformal; so is M → S → φ(S). The map of the mesh φ(S) must be φ(S) up to Möbius:
  // cross-ratios agree with those of S, the better the finer the mesh.
  double previous = 0;
  for (const int levels : {3, 4}) {
    const ClosedMesh body = star_shaped(levels, 5, 0.4);
    const SphericalMap first = tight(body);
    REQUIRE(first.status == Status::certified);
    const Points warped = moebius(first.S, Eigen::Vector3d(1, 2, 0.2).normalized(), 1.8);
    const SphericalMap second = tight({warped, body.F});
    REQUIRE(second.status == Status::certified);
    double error = 0;
    for (const std::array<int, 4> at :
         {std::array<int, 4>{0, 1, 2, 3}, {0, 4, 7, 9}, {5, 2, 8, 11}}) {
      const std::complex<double> expected = cross_ratio(first.S, at);
      error = std::max(error, std::abs(cross_ratio(second.S, at) - expected) / std::abs(expected));
    }
    INFO("levels = " << levels << ", error = " << error);
    CHECK(error < 0.05);
    if (previous > 1e-8) CHECK(error < previous / 2.5);
    previous = error;
  }
}

TEST_CASE("energy less area is not negative and falls as the square of the edge length") {
  double previous = 0;
  for (const int levels : {2, 3, 4, 5}) {
    const ClosedMesh mesh = star_shaped(levels, 3, 0.3);
    const SphericalMap map = spherical_map(mesh.V, mesh.F);
    REQUIRE(map.status == Status::certified);
    const double excess = map.distortion.energy_over_area - 1;
    INFO("levels = " << levels << ", E/A - 1 = " << excess);
    CHECK(excess >= 0);
    if (levels > 3) CHECK(excess == Approx(previous / 4).epsilon(0.25));
    previous = excess;
  }
}

TEST_CASE("the map turns with the mesh and does not see its size and place") {
  const bool linear = GENERATE(false, true);
  const ClosedMesh mesh = star_shaped(3, 1);
  SphericalMapOptions options;
  options.linear = linear;
  options.function_tolerance = 1e-12;
  const SphericalMap map = spherical_map(mesh.V, mesh.F, options);
  REQUIRE(map.status == Status::certified);
  const Eigen::Matrix3d R = some_rotation();
  for (const double scale : {1e-6, 1.0, 1e6}) {
    Points V = scale * mesh.V * R.transpose();
    V.rowwise() += scale * Eigen::RowVector3d(3, -7, 11);
    const SphericalMap moved = spherical_map(V, mesh.F, options);
    REQUIRE(moved.status == Status::certified);
    INFO("scale = " << scale);
    CHECK(largest_distance(moved.S, map.S * R.transpose()) < (linear ? 1e-9 : 1e-5));
  }
  // In the pose that turns it back it is the same map.
  options.pose = R.transpose();
  const SphericalMap posed = spherical_map(mesh.V * R.transpose(), mesh.F, options);
  CHECK(largest_distance(posed.S, map.S) < (linear ? 1e-9 : 1e-5));
}

TEST_CASE("the map does not depend on the order of vertices and triangles") {
  const bool linear = GENERATE(false, true);
  const ClosedMesh mesh = star_shaped(3, 2);
  std::mt19937 random(3);
  std::vector<int> place(mesh.V.rows());  // vertex i becomes place[i]
  std::iota(place.begin(), place.end(), 0);
  std::shuffle(place.begin(), place.end(), random);
  std::vector<int> order(mesh.F.rows());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  ClosedMesh mixed = mesh;
  for (std::size_t i = 0; i < place.size(); ++i) mixed.V.row(place[i]) = mesh.V.row(i);
  for (std::size_t t = 0; t < order.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      mixed.F(t, k) = place[mesh.F(order[t], (k + static_cast<int>(t)) % 3)];
    }
  }
  SphericalMapOptions options;
  options.linear = linear;
  options.function_tolerance = 1e-12;
  const SphericalMap map = spherical_map(mesh.V, mesh.F, options);
  const SphericalMap other = spherical_map(mixed.V, mixed.F, options);
  REQUIRE(map.status == Status::certified);
  REQUIRE(other.status == Status::certified);
  Points back = other.S;
  for (std::size_t i = 0; i < place.size(); ++i) back.row(i) = other.S.row(place[i]);
  CHECK(largest_distance(back, map.S) < (linear ? 1e-9 : 1e-5));
}

TEST_CASE("the minimum is stationary: Ceres lowers the linear map's cost and its angle change") {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const ClosedMesh mesh = spharm_body(3, seed);
    const SphericalMap map = spherical_map(mesh.V, mesh.F);
    REQUIRE(map.status == Status::certified);
    const MinimisationSummary& m = map.minimisation;
    CHECK(m.used);
    CHECK(m.iterations >= 2);
    CHECK(m.final_cost < m.initial_cost);
    CHECK((m.termination == "CONVERGENCE" || m.termination == "USER_SUCCESS"));
    CHECK_FALSE(m.message.empty());
    CHECK(map.distortion.angle_change.mean <= map.linear_distortion.angle_change.mean);
    // Beginning anew at the minimum, seen as a mesh-to-sphere cost, nothing is left to gain.
    const SphericalMap tighter = tight(mesh);
    CHECK(tighter.minimisation.final_cost <= m.final_cost * (1 + 1e-9));
    CHECK(tighter.minimisation.final_cost > m.final_cost * (1 - 1e-2));
  }
}

TEST_CASE("star-shaped and spherical-harmonic bodies are certified") {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const ClosedMesh mesh = seed % 2 ? star_shaped(3, seed) : spharm_body(3, seed, 0.8);
    const SphericalMap map = spherical_map(mesh.V, mesh.F);
    INFO("seed = " << seed << ": " << to_string(map.status));
    CHECK(map.status == Status::certified);
    CHECK(certify(map.S, mesh.F).bijective());
    CHECK(map.certificate.total_solid_angle == Approx(12.566370614359172));
    CHECK((map.S.rowwise().norm().array() - 1).abs().maxCoeff() < 1e-14);
  }
}

TEST_CASE("capsules of up to 60 radii are certified, and crowded exponentially") {
  // On a cylinder of radius 1 the conformal factor falls as exp(−distance).
  for (const double length : {10.0, 20.0, 40.0, 60.0}) {
    const ClosedMesh mesh = capsule(length, 24);
    const SphericalMap map = spherical_map(mesh.V, mesh.F);
    INFO("length = " << length << ": " << to_string(map.status));
    REQUIRE(map.status == Status::certified);
    const double expected = 0.2 * std::exp(-0.5 * length);
    CHECK(map.distortion.shortest_edge < 5 * expected);
    CHECK(map.distortion.shortest_edge > expected / 50);
  }
}

TEST_CASE("what double cannot tell apart is a named status and no map") {
  const ClosedMesh mesh = capsule(200, 12);
  for (const bool linear : {true, false}) {
    SphericalMapOptions options;
    options.linear = linear;
    const SphericalMap map = spherical_map(mesh.V, mesh.F, options);
    CHECK(map.status == Status::crowded);
    CHECK(map.S.rows() == 0);
    CHECK_FALSE(map.certificate.bijective());
  }
}

TEST_CASE("a tetrahedron is mapped, the regular one onto its directions") {
  ClosedMesh mesh{Points(4, 3), Triangles(4, 3)};
  mesh.V << 1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1;
  mesh.F << 0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2;
  if (certify(mesh.V, mesh.F).degree < 0) mesh.F.col(0).swap(mesh.F.col(1));
  const SphericalMap map = tight(mesh);
  REQUIRE(map.status == Status::certified);
  CHECK(largest_distance(map.S, mesh.V / std::sqrt(3.0)) < 0.05);  // one vertex is free
  mesh.V.row(0) *= 4;
  CHECK(spherical_map(mesh.V, mesh.F).status == Status::certified);
}

TEST_CASE("degenerate triangles are mapped like slightly fattened ones") {
  // A vertex in the middle of an edge, and one on top of another.
  ClosedMesh mesh = icosphere(2);
  const std::int32_t a = mesh.F(0, 0), b = mesh.F(0, 1), c = mesh.F(0, 2);
  const auto n = static_cast<std::int32_t>(mesh.V.rows());
  const bool coincident = GENERATE(false, true);
  mesh.V.conservativeResize(n + 1, 3);
  mesh.V.row(n) = coincident ? mesh.V.row(a) : (0.5 * (mesh.V.row(a) + mesh.V.row(b))).eval();
  mesh.F.conservativeResize(mesh.F.rows() + 2, 3);
  mesh.F.row(0) << a, b, n;
  mesh.F.row(mesh.F.rows() - 2) << b, c, n;
  mesh.F.row(mesh.F.rows() - 1) << c, a, n;
  const SphericalMap map = spherical_map(mesh.V, mesh.F);
  CHECK(map.status == Status::certified);
  CHECK(map.distortion.unmeasured_triangles >= 1);
}

TEST_CASE("a mesh turned inside out is mapped with its mirror image") {
  ClosedMesh mesh = icosphere(2);
  mesh.F.col(0).swap(mesh.F.col(1));
  const SphericalMap map = tight(mesh);
  REQUIRE(map.status == Status::certified);
  CHECK(map.distortion.angle_change.max < 0.2);
  const Eigen::Matrix3d A =
      (map.S.transpose() * mesh.V) / (static_cast<double>(mesh.V.rows()) / 3.0);
  CHECK(A.determinant() == Approx(-1).margin(1e-3));
}

TEST_CASE("the harmonic energy is minimised, too") {
  const ClosedMesh mesh = star_shaped(3, 4, 0.3);
  const SphericalMap harmonic = tight(mesh, Energy::harmonic), conformal = tight(mesh);
  REQUIRE(harmonic.status == Status::certified);
  CHECK(harmonic.minimisation.final_cost < harmonic.minimisation.initial_cost);
  // Both converge to the conformal map: they differ by the error of the discretisation.
  CHECK(mean_square(harmonic.S, conformal.S) < 0.02);
  CHECK(harmonic.distortion.energy_over_area < conformal.distortion.energy_over_area * (1 + 1e-3));
}

TEST_CASE("balanced areas starve less of a capsule, at a distortion that is reported") {
  const ClosedMesh mesh = capsule(12, 20);
  const SphericalMap conformal = spherical_map(mesh.V, mesh.F);
  REQUIRE(conformal.status == Status::certified);
  CHECK_FALSE(conformal.balancing.used);
  CHECK(conformal.distortion.starved_area_share > 0.2);
  double starved = conformal.distortion.starved_area_share;
  double sigma = conformal.distortion.sigma_ratio.mean;
  for (const double weight : {0.01, 0.1, 1.0}) {
    SphericalMapOptions options;
    options.area_balance = weight;
    const SphericalMap balanced = spherical_map(mesh.V, mesh.F, options);
    INFO("weight = " << weight << ", starved " << balanced.distortion.starved_area_share
                     << ", mean sigma ratio " << balanced.distortion.sigma_ratio.mean);
    REQUIRE(balanced.status == Status::certified);
    CHECK(balanced.balancing.used);
    CHECK(balanced.balancing.final_cost < balanced.balancing.initial_cost);
    CHECK(balanced.conformal_distortion.angle_change.mean ==
          conformal.distortion.angle_change.mean);
    CHECK(balanced.distortion.starved_area_share <= starved);
    CHECK(balanced.distortion.sigma_ratio.mean > sigma);
    starved = balanced.distortion.starved_area_share;
    sigma = balanced.distortion.sigma_ratio.mean;
  }
  CHECK(starved == 0);
}

TEST_CASE("the same bytes every time, alone and beside others") {
  const ClosedMesh mesh = spharm_body(3, 9);
  const SphericalMap alone = spherical_map(mesh.V, mesh.F);
  std::vector<std::future<SphericalMap>> beside;
  for (int i = 0; i < 3; ++i) {
    beside.push_back(
        std::async(std::launch::async, [&mesh] { return spherical_map(mesh.V, mesh.F); }));
  }
  for (auto& other : beside) CHECK((other.get().S.array() == alone.S.array()).all());
}

TEST_CASE("progress rises from stage to stage, and false cancels at each") {
  const ClosedMesh mesh = icosphere(2);
  std::vector<double> shares;
  SphericalMapOptions options;
  options.progress = [&shares](double share) {
    shares.push_back(share);
    return true;
  };
  REQUIRE(spherical_map(mesh.V, mesh.F, options).status == Status::certified);
  REQUIRE(shares.size() >= 4);
  CHECK(std::is_sorted(shares.begin(), shares.end()));
  CHECK(shares.front() > 0);
  CHECK(shares.back() <= 1);
  for (std::size_t stop = 0; stop < shares.size(); ++stop) {
    std::size_t calls = 0;
    options.progress = [&calls, stop](double) { return calls++ < stop; };
    const SphericalMap map = spherical_map(mesh.V, mesh.F, options);
    CHECK(map.status == Status::cancelled);
    CHECK(map.S.rows() == 0);
    CHECK(calls == stop + 1);
  }
}

TEST_CASE("seconds and Ceres' summary are filled in") {
  const ClosedMesh mesh = star_shaped(3, 6);
  SphericalMapOptions options;
  options.max_iterations = 1;
  const SphericalMap map = spherical_map(mesh.V, mesh.F, options);
  REQUIRE(map.status == Status::certified);
  CHECK(map.minimisation.iterations == 1);
  CHECK(map.minimisation.termination == "NO_CONVERGENCE");
  const StageSeconds& s = map.seconds;
  const double sum =
      s.delaunay + s.linear + s.untangle + s.minimise + s.centre + s.certificate + s.distortion;
  CHECK(sum <= s.total * (1 + 1e-9));
  CHECK(sum > 0.9 * s.total);
  options.linear = true;
  const SphericalMap linear = spherical_map(mesh.V, mesh.F, options);
  CHECK_FALSE(linear.minimisation.used);
  CHECK(linear.seconds.minimise == 0);
}

}  // namespace
