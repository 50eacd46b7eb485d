#include "shape3d/mapping/spherical_map.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/LU>

#include "dipole.hpp"
#include "elimination_order.hpp"
#include "intrinsic.hpp"
#include "minimise.hpp"
#include "mobius.hpp"
#include "surface.hpp"
#include "triangle.hpp"
#include "untangle.hpp"

namespace shape3d::mapping {
namespace {

class Stopwatch {
 public:
  /// Seconds since the last call.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void require_options(const SphericalMapOptions& options) {
  const auto refuse = [](const std::string& name, const std::string& value,
                         const std::string& expected) {
    throw std::invalid_argument("options." + name + " is " + value + "; expected " + expected);
  };
  if (options.max_iterations < 1) {
    refuse("max_iterations", std::to_string(options.max_iterations), "1 or more");
  }
  if (!(options.function_tolerance > 0 && options.function_tolerance < 1)) {
    refuse("function_tolerance", std::to_string(options.function_tolerance),
           "a number between 0 and 1");
  }
  if (!(options.area_balance >= 0 && std::isfinite(options.area_balance))) {
    refuse("area_balance", std::to_string(options.area_balance), "0 or a positive number");
  }
  const Eigen::Matrix3d defect =
      options.pose * options.pose.transpose() - Eigen::Matrix3d::Identity();
  // Negated so that NaN is refused, too.
  if (!(defect.cwiseAbs().maxCoeff() < 1e-9) || !(options.pose.determinant() > 0)) {
    refuse("pose", "no rotation (determinant " + std::to_string(options.pose.determinant()) + ")",
           "an orthogonal matrix of determinant 1");
  }
}

/// V with its bounding box about the origin and of size 1, so that products neither overflow nor
/// vanish.
Points normalised(const ConstPoints& V) {
  // Halved before they are subtracted: the difference of the largest doubles overflows.
  const Eigen::RowVector3d low = 0.5 * V.colwise().minCoeff(), high = 0.5 * V.colwise().maxCoeff();
  const double extent = (high - low).maxCoeff();
  if (!(extent > 0)) {
    throw std::invalid_argument("V: all vertices are in one place; expected a surface with area");
  }
  return (((0.5 * V).rowwise() - 0.5 * (high + low)) / extent).eval();
}

/// A third of the area of the triangles around each vertex.
Eigen::VectorXd vertex_areas(const Points& V, const ConstTriangles& F) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(V.rows());
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const double third =
        plane_triangle(row(V, F(t, 0)), row(V, F(t, 1)), row(V, F(t, 2))).area() / 3;
    for (int k = 0; k < 3; ++k) areas[F(t, k)] += third;
  }
  if (!(areas.sum() > 0)) {
    throw std::invalid_argument("V, F: all triangles have zero area; expected a surface with area");
  }
  return areas;
}

Points centred(const PlanePoints& z, const Eigen::VectorXd& areas) {
  const Similarity to = conformal_barycentre(z, areas);
  Points S(static_cast<Eigen::Index>(z.size()), 3);
  for (std::size_t i = 0; i < z.size(); ++i) {
    // Conjugated: stereographic projection seen from outside the sphere reverses orientation.
    const Complex w = std::conj((z[i] - to.centre) / to.scale);
    S.row(static_cast<Eigen::Index>(i)) = to_sphere(w).transpose();
  }
  return S;
}

PlanePoints in_plane(const Points& S) {
  PlanePoints z(static_cast<std::size_t>(S.rows()));
  for (Eigen::Index i = 0; i < S.rows(); ++i) z[i] = std::conj(to_plane(row(S, i)));
  return z;
}

class Mapper {
 public:
  Mapper(const ConstPoints& V, const ConstTriangles& F, const SphericalMapOptions& options)
      : F_(F),
        options_(options),
        twins_(genus_zero_twins(F, V.rows())),
        V_(normalised(V)),
        areas_(vertex_areas(V_, F)) {}

  SphericalMap run() {
    Stopwatch whole;
    map_.status = compute();
    if (map_.status != Status::certified) map_.S.resize(0, 3);
    map_.seconds.total = whole.lap();
    return std::move(map_);
  }

 private:
  [[nodiscard]] bool go_on(double share) const {
    return !options_.progress || options_.progress(share);
  }

  Status compute() {
    Stopwatch watch;
    IntrinsicTriangulation mesh = intrinsic_triangulation(V_, F_, twins_);
    make_delaunay(mesh);
    map_.delaunay_flips = mesh.flips;
    map_.seconds.delaunay = watch.lap();
    if (!go_on(0.05)) return Status::cancelled;
    HalfEdges edges;
    edges.reserve(mesh.origin.size());
    for (std::int32_t h = 0; h < static_cast<std::int32_t>(mesh.origin.size()); ++h) {
      edges.push_back({mesh.origin[h], mesh.target(h)});
    }
    const DipoleSolver solver(mesh, elimination_order(V_, edges));
    if (!solver.factorised()) return Status::solver_failed;
    map_.seconds.linear = watch.lap();
    if (!go_on(0.15)) return Status::cancelled;

    constexpr std::size_t kPoles = 4;
    std::vector<std::int32_t> poles = pole_candidates(mesh, extremity(), 1);
    Points linear;
    while (map_.poles_tried < static_cast<int>(poles.size())) {
      const std::int32_t pole = poles[map_.poles_tried++];
      PlanePoints z = solver.solve(pole);
      remove_dilatation(mesh, pole, z);
      map_.seconds.linear += watch.lap();
      linear = centred(z, areas_);
      map_.seconds.centre += watch.lap();
      const Untangling untangling = untangle(V_, F_, twins_, linear);
      map_.untangled_triangles = untangling.found - untangling.left;
      map_.seconds.untangle += watch.lap();
      map_.certificate = certify(linear, F_);
      map_.seconds.certificate += watch.lap();
      if (map_.certificate.bijective()) break;
      if (!go_on(0.15)) return Status::cancelled;
      if (poles.size() == 1)
        poles = pole_candidates(mesh, extremity(), kPoles);  // begins with the same one
    }
    map_.linear_distortion = measure_distortion(V_, F_, linear);
    map_.seconds.distortion += watch.lap();
    if (!map_.certificate.bijective()) {
      map_.distortion = map_.linear_distortion;
      return failure();
    }
    if (!go_on(0.2)) return Status::cancelled;

    std::vector<Points> maps{linear};  // the later, the better
    if (!options_.linear) {
      order_ = elimination_order(linear, half_edges(F_));
      map_.S = std::move(linear);
      if (!minimised(0, map_.minimisation)) return Status::cancelled;
      maps.push_back(map_.S);
      if (refining()) {
        if (!refined()) return Status::cancelled;
        maps.push_back(map_.S);
      }
      map_.seconds.minimise = watch.lap();
    }
    for (; !maps.empty(); maps.pop_back()) {
      // The linear map is centred.
      map_.S = maps.size() > 1 ? centred(in_plane(maps.back()), areas_) : std::move(maps.back());
      turn(map_.S);
      map_.seconds.centre += watch.lap();
      if (finished()) return balanced();
      watch.lap();
    }
    return failure();
  }

  /// From a certified conformal map to the one with the areas balanced.
  Status balanced() {
    if (!(options_.area_balance > 0)) return Status::certified;
    Stopwatch watch;
    map_.conformal_distortion = map_.distortion;
    const Points conformal = map_.S;
    if (!minimised(options_.area_balance, map_.balancing)) return Status::cancelled;
    map_.seconds.minimise += watch.lap();
    turn(map_.S);
    map_.seconds.centre += watch.lap();
    if (finished()) return Status::certified;
    map_.S = conformal;
    return finished() ? Status::certified : failure();
  }

  bool minimised(double area_weight, MinimisationSummary& summary) {
    MinimiseSettings settings;
    settings.energy = options_.energy;
    settings.area_weight = area_weight;
    settings.max_iterations = options_.max_iterations;
    // Where the refinement goes on it need not be exact.
    settings.function_tolerance = area_weight == 0 && refining()
                                      ? std::sqrt(options_.function_tolerance)
                                      : options_.function_tolerance;
    settings.order = order_;
    settings.iterate = [this, area_weight](int iteration) {
      // Convergence takes some ten iterations.
      const double share = 0.95 - 0.75 * std::exp(-0.15 * iteration);
      shown_ = std::max(shown_, area_weight > 0 ? 0.95 : share);
      return go_on(shown_);
    };
    return minimise(V_, F_, twins_, settings, map_.S, summary);
  }

  [[nodiscard]] bool refining() const {
    return options_.refine_angles && options_.energy == Energy::conformal;
  }

  bool refined() {
    MinimiseSettings settings;
    settings.max_iterations = options_.max_iterations;
    // Most is won in the first steps; re-weighting converges linearly.
    settings.function_tolerance = std::min(0.1, 10 * options_.function_tolerance);
    settings.largest_radius = 1e8;  // rotations about the held vertex need some damping
    settings.order = order_;
    settings.iterate = [this](int iteration) {
      shown_ = std::max(shown_, 0.95 - 0.3 * std::exp(-0.3 * iteration));
      return go_on(shown_);
    };
    return refine_angles(V_, F_, twins_, settings, map_.S, map_.refinement);
  }

  [[nodiscard]] Eigen::RowVector3d centroid() const {
    return (areas_.transpose() * V_) / areas_.sum();
  }

  /// The vertex farthest from the centroid.
  [[nodiscard]] std::int32_t extremity() const {
    Eigen::Index farthest = 0;
    (V_.rowwise() - centroid()).rowwise().squaredNorm().maxCoeff(&farthest);
    return static_cast<std::int32_t>(farthest);
  }

  /// Lays the map as the posed mesh lies.
  void turn(Points& S) const {
    const Points posed = (V_.rowwise() - centroid()) * options_.pose.transpose();
    const Eigen::Matrix3d R = closest_rotation(S, posed, areas_);
    S = (S * R.transpose()).eval();
    S.rowwise().normalize();
  }

  /// Certifies and measures S; repairs what rounding flipped.
  bool finished() {
    Stopwatch watch;
    map_.certificate = certify(map_.S, F_);
    map_.seconds.certificate += watch.lap();
    if (!map_.certificate.bijective()) {
      untangle(V_, F_, twins_, map_.S);
      map_.seconds.untangle += watch.lap();
      map_.certificate = certify(map_.S, F_);
      map_.seconds.certificate += watch.lap();
    }
    map_.distortion = measure_distortion(V_, F_, map_.S);
    map_.seconds.distortion += watch.lap();
    return map_.certificate.bijective();
  }

  [[nodiscard]] Status failure() const {
    const Certificate& c = map_.certificate;
    if (c.flipped == 0 && c.degenerate == 0) return Status::wrong_degree;
    // Positions are rounded to 1e-16: an edge of 1e-14 is known to a hundredth.
    return map_.distortion.shortest_edge < 1e-14 ? Status::crowded : Status::tangled;
  }

  const ConstTriangles& F_;
  const SphericalMapOptions& options_;
  Twins twins_;
  Points V_;
  Eigen::VectorXd areas_;
  std::vector<std::int32_t> order_;  ///< Of elimination.
  double shown_ = 0.2;               ///< Share last reported by the minimisation.
  SphericalMap map_;
};

}  // namespace

SphericalMap spherical_map(const ConstPoints& V, const ConstTriangles& F,
                           const SphericalMapOptions& options) {
  require_options(options);
  require_finite(V, "V");
  Stopwatch watch;
  Mapper mapper(V, F, options);
  const double checks = watch.lap();
  SphericalMap map = mapper.run();
  map.seconds.delaunay += checks;
  map.seconds.total += checks;
  return map;
}

}  // namespace shape3d::mapping
