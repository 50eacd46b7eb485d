#include "shape3d/zmc/contour.hpp"

#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "shape3d/zmc/extract.hpp"
#include "support/random_volume.hpp"
#include "surface_set.hpp"

namespace {
using namespace shape3d::zmc;
using namespace shape3d::zmc::test;
using shape3d::test::random_samples;

using Dims = std::array<std::int64_t, 3>;
using Edge = std::pair<reference::Vertex, reference::Vertex>;

Dims lattice(const reference::Volume& volume, std::int64_t n) {
  return {n % volume.dims[0], n / volume.dims[0] % volume.dims[1],
          n / (volume.dims[0] * volume.dims[1])};
}

/// The chain of the layer of cells beside a lattice plane: its boundary in the plane, as a signed
/// count of how often each edge (smaller vertex first) is run forwards, and a plain count.
struct Boundary {
  std::map<Edge, int> signed_count, count;
};
Boundary layer_boundary(const reference::Volume& volume, const reference::SurfaceSet& surface,
                        int axis, std::int64_t slice) {
  const std::int64_t layer = std::min(slice, volume.dims[axis] - 2);
  const auto coordinates = [&](const reference::Vertex& v) {
    return std::pair{lattice(volume, v.a)[axis], lattice(volume, v.b)[axis]};
  };
  Boundary result;
  const auto add = [&](const reference::Cycle& cycle) {
    for (std::size_t n = 0; n < cycle.size(); ++n) {
      const reference::Vertex a = cycle[n], b = cycle[(n + 1) % cycle.size()];
      const std::pair on{slice, slice};
      if (coordinates(a) != on || coordinates(b) != on) continue;
      const Edge edge = a < b ? Edge{a, b} : Edge{b, a};
      result.signed_count[edge] += a < b ? 1 : -1;
      ++result.count[edge];
    }
  };
  for (const auto& patch : surface.patches) {
    if (lattice(volume, patch.cell)[axis] == layer) add(patch.cycle);
  }
  // Polygons in faces across the plane, between two cells of the layer.
  const auto add_across = [&](const std::vector<reference::Cycle>& polygons) {
    for (const reference::Cycle& cycle : polygons) {
      std::int64_t lowest = volume.dims[axis], highest = 0;
      for (const reference::Vertex& v : cycle) {
        lowest = std::min(lowest, coordinates(v).first);
        highest = std::max(highest, coordinates(v).second);
      }
      if (lowest == layer && highest == layer + 1) add(cycle);
    }
  };
  add_across(surface.zero_faces);
  add_across(surface.closing);
  return result;
}

/// Compares every contour of a volume with the reference's, as sets of directed edges.
void check_contours(const reference::Volume& volume, const Options& options, bool closed) {
  const auto expected = reference::extract(
      options.inside == Inside::below ? volume : negated(volume),
      {options.ties == TieRule::neutral ? reference::Ties::neutral : reference::Ties::positive,
       options.zero_faces == ZeroFaces::mating});
  for (int axis = 0; axis < 3; ++axis) {
    for (std::int64_t slice = 0; slice < volume.dims[axis]; ++slice) {
      INFO("axis " << axis << ", slice " << slice);
      const Contour got =
          contour(make_view(volume.samples.data(), volume.dims), 0.0, axis, slice, options);
      const Boundary want = layer_boundary(volume, expected.surface, axis, slice);

      std::vector<reference::Vertex> names;
      for (std::int64_t v = 0; v < got.V.rows(); ++v) {
        names.push_back(vertex_at(got.V.row(v), volume));
        const auto place = position(volume, names.back());
        const Eigen::Vector3d p(place[0], place[1], place[2]);
        if (!got.V.row(v).transpose().isApprox(p, 1e-13)) FAIL_CHECK("vertex " << v);
      }
      CHECK(std::set<reference::Vertex>(names.begin(), names.end()).size() == names.size());

      std::set<Edge> edges;
      std::map<int, int> degree;
      bool directed = true;
      for (std::int64_t e = 0; e < got.E.rows(); ++e) {
        const reference::Vertex a = names[got.E(e, 0)], b = names[got.E(e, 1)];
        const Edge edge = a < b ? Edge{a, b} : Edge{b, a};
        if (!edges.insert(edge).second) FAIL_CHECK("an edge twice");
        ++degree[got.E(e, 0)];
        ++degree[got.E(e, 1)];
        // The layer below the last plane sees it from the other side.
        const auto found = want.signed_count.find(edge);
        int forwards = found == want.signed_count.end() ? 0 : found->second;
        if (slice == volume.dims[axis] - 1) forwards = -forwards;
        directed = directed && (a < b) == (forwards > 0);
      }
      CHECK(directed);
      std::set<Edge> odd;
      for (const auto& [edge, count] : want.count) {
        if (count % 2 == 1) odd.insert(edge);
      }
      CHECK((edges == odd));
      CHECK(degree.size() == names.size());  // No vertex without an edge.
      if (!closed) continue;
      // Closed, except where it meets the border of the volume's plane.
      for (const auto& [v, d] : degree) {
        bool at_border = false;
        for (int other = 0; other < 3; ++other) {
          if (other == axis) continue;
          at_border = at_border || got.V(v, other) == 0.0 ||
                      got.V(v, other) == static_cast<double>(volume.dims[other] - 1);
        }
        if (!at_border && d % 2 != 0) FAIL_CHECK("odd degree at vertex " << v);
      }
    }
  }
}

TEST_CASE("the contour is the boundary of the surface in the layer of cells", "[zmc][contour]") {
  const int zeros = GENERATE(0, 5, 30, 60, 80, 90, 97);
  const auto ties = GENERATE(TieRule::neutral, TieRule::positive);
  const auto inside = GENERATE(Inside::below, Inside::above);
  const Dims dims = GENERATE(Dims{9, 8, 7}, Dims{66, 5, 4});
  const std::vector<int> samples = random_samples(dims, 2, zeros, 30 + zeros);
  Options options;
  options.ties = ties;
  options.inside = inside;
  INFO("zeros " << zeros << " %");
  check_contours({dims, {samples.begin(), samples.end()}}, options, true);
}

TEST_CASE("contours of masked volumes and in mating mode", "[zmc][contour]") {
  const int zeros = GENERATE(0, 30, 60, 80, 90);
  const bool mask = GENERATE(true, false);
  const Dims dims{9, 8, 7};
  const std::vector<int> samples = random_samples(dims, 2, zeros, 33 + zeros);
  reference::Volume volume{dims, {samples.begin(), samples.end()}};
  Options options;
  if (mask) {
    for (std::size_t n = 5; n < volume.samples.size(); n += 37) volume.samples[n] = std::nan("");
    options.non_finite = NonFinite::mask;
  } else {
    options.zero_faces = ZeroFaces::mating;
  }
  INFO("zeros " << zeros << " %" << (mask ? ", masked" : ", mating"));
  check_contours(volume, options, false);
}

TEST_CASE("the contour of a sphere is a circle", "[zmc][contour]") {
  // Length 2 pi r and area pi r^2 of the section at second order; counter-clockwise round the
  // inside seen against the axis.
  const int axis = GENERATE(0, 1, 2);
  const auto inside = GENERATE(Inside::below, Inside::above);
  Options options;
  options.inside = inside;
  const double height = 0.25, r = std::sqrt(1.0 - height * height);
  std::vector<std::pair<double, double>> errors;
  for (const int n : {1, 2, 4}) {
    const double h = 0.125 / n;
    const std::int64_t size = 20 * n + 1;
    std::vector<double> samples;
    for (std::int64_t k = 0; k < size; ++k) {
      for (std::int64_t j = 0; j < size; ++j) {
        for (std::int64_t i = 0; i < size; ++i) {
          const Eigen::Array3d p = Eigen::Array3d(static_cast<double>(i), static_cast<double>(j),
                                                  static_cast<double>(k)) *
                                       h -
                                   1.25;
          samples.push_back(p.matrix().norm() - 1.0);
        }
      }
    }
    const VolumeView view =
        make_view(samples.data(), {size, size, size}, Eigen::Vector3d::Constant(h),
                  Eigen::Vector3d::Constant(-1.25));
    const auto slice = static_cast<std::int64_t>(std::lround((height + 1.25) / h));
    const Contour circle = contour(view, 0.0, axis, slice, options);
    double length = 0.0, area = 0.0;
    std::map<int, int> out, in;
    for (std::int64_t e = 0; e < circle.E.rows(); ++e) {
      const Eigen::Vector3d a = circle.V.row(circle.E(e, 0)), b = circle.V.row(circle.E(e, 1));
      CHECK(a[axis] == Approx(height));
      length += (b - a).norm();
      area += a.cross(b)[axis] / 2.0;
      ++out[circle.E(e, 0)];
      ++in[circle.E(e, 1)];
    }
    CHECK(out == in);
    CHECK(out.size() == static_cast<std::size_t>(circle.V.rows()));
    CHECK(circle.E.rows() == circle.V.rows());  // One loop or more, here one.
    if (inside == Inside::above) area = -area;
    errors.emplace_back(std::abs(length - 2.0 * M_PI * r), std::abs(area - M_PI * r * r));
  }
  INFO(errors[0].first << ' ' << errors[1].first << ' ' << errors[2].first);
  INFO(errors[0].second << ' ' << errors[1].second << ' ' << errors[2].second);
  CHECK(errors[2].first < errors[0].first / 8.0);
  CHECK(errors[2].second < errors[0].second / 8.0);
  CHECK(errors[2].first < 2e-3);
  CHECK(errors[2].second < 2e-3);
}

TEST_CASE("the contour lies in the frame of the view", "[zmc][contour]") {
  const Dims dims{8, 7, 6};
  const std::vector<int> samples = random_samples(dims, 2, 30, 31);
  const std::vector<std::int16_t> data(samples.begin(), samples.end());
  const VolumeView plain = make_view(data.data(), dims);
  VolumeView view = make_view(data.data(), dims, {0.5, 2.0, 3.0}, {10.0, 20.0, -30.0});
  view.direction = Eigen::AngleAxisd(1.1, Eigen::Vector3d(3, -1, 2).normalized()).matrix();
  view.direction.col(0) *= -1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const Contour expected = contour(plain, 0.5, axis, 2);
    const Contour got = contour(view, 0.5, axis, 2);
    REQUIRE(got.V.rows() == expected.V.rows());
    CHECK(got.E == expected.E);
    for (std::int64_t v = 0; v < got.V.rows(); ++v) {
      const Eigen::Vector3d place = view.world(expected.V.row(v).transpose());
      CHECK(got.V.row(v).transpose().isApprox(place, 1e-12));
    }
  }
}

TEST_CASE("contour names what it refuses", "[zmc][contract]") {
  std::vector<double> samples(60, 1.0);
  const auto view = make_view(samples.data(), {3, 4, 5});
  const auto message = [&](int axis, std::int64_t slice, double isovalue, const Options& options) {
    try {
      (void)contour(view, isovalue, axis, slice, options);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  using Catch::Matchers::Contains;
  CHECK_THAT(message(3, 0, 0.0, {}), Contains("axis") && Contains("3"));
  CHECK_THAT(message(-1, 0, 0.0, {}), Contains("axis") && Contains("-1"));
  CHECK_THAT(message(0, 3, 0.0, {}), Contains("slice") && Contains("3"));
  CHECK_THAT(message(2, -1, 0.0, {}), Contains("slice") && Contains("-1"));
  CHECK_THAT(message(2, 5, 0.0, {}), Contains("slice") && Contains("5"));
  CHECK(message(2, 4, 0.0, {}) == "nothing thrown");
  CHECK_THAT(message(0, 0, std::nan(""), {}), Contains("isovalue"));
  Options options;
  options.border = Border::capped;
  CHECK_THAT(message(0, 0, 0.0, options), Contains("capped"));
  samples[7] = std::nan("");
  CHECK_THAT(message(0, 0, 0.0, {}), Contains("(1, 2, 0)"));
}
}  // namespace
