#include "shape3d/zmc/extract.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "support/random_volume.hpp"
#include "surface_set.hpp"

namespace {
using namespace shape3d::zmc;
using namespace shape3d::zmc::test;
using shape3d::test::random_samples;

using Dims = std::array<std::int64_t, 3>;
using Mesh = Surface<double, std::int32_t>;

bool same(const Mesh& a, const Mesh& b) {
  return a.positions == b.positions && a.indices == b.indices &&
         a.first_zero_face == b.first_zero_face && a.first_closing == b.first_closing;
}

/// |x - c| - r at the samples of a lattice with unit spacing.
std::vector<double> sphere(const Dims& dims, const Eigen::Vector3d& centre, double radius) {
  std::vector<double> result;
  for (std::int64_t k = 0; k < dims[2]; ++k) {
    for (std::int64_t j = 0; j < dims[1]; ++j) {
      for (std::int64_t i = 0; i < dims[0]; ++i) {
        result.push_back((Eigen::Array3d(static_cast<double>(i), static_cast<double>(j),
                                         static_cast<double>(k)) -
                          centre.array())
                             .matrix()
                             .norm() -
                         radius);
      }
    }
  }
  return result;
}

template <class T>
Mesh extract_as(const std::vector<int>& samples, const Dims& dims, double isovalue, int shift = 0,
                const Options& options = {}) {
  std::vector<T> typed;
  for (const int s : samples) typed.push_back(static_cast<T>(s + shift));
  return extract(make_view(typed.data(), dims), isovalue + shift, options);
}

TEST_CASE("every sample type gives the same surface", "[zmc][extract]") {
  const Dims dims{70, 9, 8};
  const int zeros = GENERATE(0, 30, 80);
  const double isovalue = GENERATE(0.0, 3.0, 0.5, -2.25, 0.1);
  const auto inside = GENERATE(Inside::below, Inside::above);
  Options options;
  options.inside = inside;
  const std::vector<int> samples = random_samples(dims, 50, zeros, 11);
  const Mesh expected = extract_as<double>(samples, dims, isovalue, 0, options);
  REQUIRE(expected.triangle_count() > 0);
  CHECK(same(extract_as<float>(samples, dims, isovalue, 0, options), expected));
  CHECK(same(extract_as<std::int8_t>(samples, dims, isovalue, 0, options), expected));
  CHECK(same(extract_as<std::int16_t>(samples, dims, isovalue, 0, options), expected));
  CHECK(same(extract_as<std::int32_t>(samples, dims, isovalue, 0, options), expected));
  // Shifted by 64 with the isovalue: exact unless the fraction of the isovalue is not.
  if (isovalue != 0.1) {
    CHECK(same(extract_as<std::uint8_t>(samples, dims, isovalue, 64, options), expected));
    CHECK(same(extract_as<std::uint16_t>(samples, dims, isovalue, 64, options), expected));
  }
}

TEST_CASE("extreme samples of each integer type keep their signs", "[zmc][extract]") {
  // A chequered volume of the two extreme values: every lattice edge is crossed, in the middle when
  // the isovalue is.
  const Dims dims{5, 4, 3};
  const auto check = [&](auto lowest, auto highest) {
    using T = decltype(lowest);
    std::vector<T> samples;
    for (std::int64_t k = 0; k < dims[2]; ++k) {
      for (std::int64_t j = 0; j < dims[1]; ++j) {
        for (std::int64_t i = 0; i < dims[0]; ++i) {
          samples.push_back((i + j + k) % 2 == 0 ? lowest : highest);
        }
      }
    }
    const double low = static_cast<double>(lowest), high = static_cast<double>(highest);
    const auto view = make_view(samples.data(), dims);
    for (const double isovalue : {low / 2 + high / 2, low + 0.25, high - 0.25}) {
      Options options;
      options.triangulation = Triangulation::compact;
      const Mesh mesh = extract(view, isovalue, options);
      const double t = std::clamp((isovalue - low) / (high - low), std::ldexp(1.0, -20),
                                  1.0 - std::ldexp(1.0, -20));
      CHECK(mesh.counts.zero_vertices == 0);
      const auto crossings = mesh.vertex_count() - mesh.counts.centroids;
      CHECK(crossings == 4 * 4 * 3 + 5 * 3 * 3 + 5 * 4 * 2);
      for (std::int64_t v = 0; v < mesh.vertex_count(); ++v) {
        int fractions = 0;
        double fraction = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
          const double f = mesh.V()(v, axis) - std::floor(mesh.V()(v, axis));
          if (f != 0.0) {
            ++fractions;
            fraction = f;
          }
        }
        if (fractions != 1) continue;  // A centroid.
        const bool expected = std::abs(fraction - t) < 1e-9 || std::abs(1.0 - fraction - t) < 1e-9;
        if (!expected) FAIL_CHECK("fraction " << fraction << ", t = " << t);
      }
    }
    // The extreme values themselves are zero samples then.
    CHECK(extract(view, low, {}).counts.cells_with_patch == 0);
    CHECK(extract(view, high, {}).counts.cells_with_patch == 0);
  };
  check(std::int8_t{-128}, std::int8_t{127});
  check(std::uint8_t{0}, std::uint8_t{255});
  check(std::int16_t{-32768}, std::int16_t{32767});
  check(std::uint16_t{0}, std::uint16_t{65535});
  check(std::numeric_limits<std::int32_t>::lowest(), std::numeric_limits<std::int32_t>::max());
}

TEST_CASE("isovalues that the sample type cannot represent", "[zmc][extract]") {
  const Dims dims{3, 3, 3};
  std::vector<std::uint8_t> samples(27, 10);
  samples[13] = 20;
  const auto view = make_view(samples.data(), dims);
  Mesh mesh;
  for (const double isovalue : {-1.0, 9.999, 20.001, 256.0, -1e300, 1e300, 1e10}) {
    INFO("isovalue " << isovalue);
    CHECK(extract(view, isovalue, {}, mesh) == Status::empty);
    CHECK(mesh.vertex_count() == 0);
    CHECK(mesh.triangle_count() == 0);
  }
  for (const double isovalue : {10.0000001, 12.5, 19.9999999}) {
    INFO("isovalue " << isovalue);
    REQUIRE(extract(view, isovalue, {}, mesh) == Status::ok);
    CHECK(mesh.vertex_count() == 6);  // An octahedron.
    CHECK(mesh.triangle_count() == 8);
  }
  // An isolated zero, and a value that all other samples have: nothing to separate.
  CHECK(extract(view, 20.0, {}, mesh) == Status::empty);
  // With the background on the isovalue the sample in the middle has a boundary of zero vertices.
  REQUIRE(extract(view, 10.0, {}, mesh) == Status::empty);
}

TEST_CASE("a sample one unit in the last place off the isovalue is not on it", "[zmc][extract]") {
  const Dims dims{3, 3, 3};
  const double isovalue = GENERATE(0.0, 0.1, 1.0, -1e10, 1e300);
  const double above = std::nextafter(isovalue, std::numeric_limits<double>::infinity());
  const double below = std::nextafter(isovalue, -std::numeric_limits<double>::infinity());
  std::vector<double> samples(27, above);
  samples[13] = below;
  const Mesh mesh = extract(make_view(samples.data(), dims), isovalue);
  CHECK(mesh.vertex_count() == 6);
  CHECK(mesh.triangle_count() == 8);
  CHECK(mesh.counts.zero_vertices == 0);
  CHECK(mesh.V().cwiseAbs2().rowwise().sum().allFinite());
}

TEST_CASE("samples at the ends of the range of double", "[zmc][extract]") {
  const Dims dims{3, 3, 3};
  const double huge = std::numeric_limits<double>::max();
  const double tiny = std::numeric_limits<double>::denorm_min();
  struct Case {
    double outer, middle, isovalue, t;  // t from the middle sample outwards
  };
  const double margin = std::ldexp(1.0, -20);
  for (const Case& c : {Case{huge, -huge, 0.0, 0.5}, Case{huge, -huge, huge / 2, 0.75},
                        Case{huge, -huge, -huge / 2, 0.25}, Case{tiny, -tiny, 0.0, 0.5},
                        Case{huge, -tiny, 0.0, margin}, Case{tiny, -huge, 0.0, 1.0 - margin}}) {
    std::vector<double> samples(27, c.outer);
    samples[13] = c.middle;
    INFO("outer " << c.outer << ", middle " << c.middle << ", isovalue " << c.isovalue);
    const Mesh mesh = extract(make_view(samples.data(), dims), c.isovalue);
    REQUIRE(mesh.vertex_count() == 6);
    for (int v = 0; v < 6; ++v) {
      const double distance = (mesh.V().row(v) - Eigen::RowVector3d::Ones()).norm();
      CHECK(distance == Approx(c.t).epsilon(1e-12));
    }
  }
}

TEST_CASE("views with strides equal their dense copies", "[zmc][extract]") {
  const Dims dims{67, 6, 5};
  const std::vector<int> samples = random_samples(dims, 3, 40, 12);
  const std::vector<double> dense(samples.begin(), samples.end());
  const Mesh expected = extract(make_view(dense.data(), dims), 0.0);
  const auto at = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    return dense[i + dims[0] * (j + dims[1] * k)];
  };
  const auto fill = [&](std::vector<double>& data, std::int64_t first, const Dims& strides) {
    for (std::int64_t k = 0; k < dims[2]; ++k) {
      for (std::int64_t j = 0; j < dims[1]; ++j) {
        for (std::int64_t i = 0; i < dims[0]; ++i) {
          data[first + i * strides[0] + j * strides[1] + k * strides[2]] = at(i, j, k);
        }
      }
    }
  };
  const std::int64_t nx = dims[0], ny = dims[1], nz = dims[2];
  struct Layout {
    const char* name;
    std::int64_t first;
    Dims strides;
  };
  for (const Layout& layout :
       {Layout{"dense", 0, {1, nx, nx * ny}}, Layout{"z fastest", 0, {ny * nz, nz, 1}},
        Layout{"every third", 2, {3, 3 * nx + 1, 3 * (nx + 1) * ny}},
        Layout{"x backwards", nx - 1, {-1, nx, nx * ny}},
        Layout{"all backwards", nx * ny * nz - 1, {-1, -nx, -nx * ny}}}) {
    INFO(layout.name);
    std::vector<double> data(9 * (nx + 1) * (ny + 1) * (nz + 1), 1e99);
    fill(data, layout.first, layout.strides);
    VolumeView view = make_view(data.data() + layout.first, dims);
    view.strides = layout.strides;
    CHECK(same(extract(view, 0.0), expected));
  }
}

TEST_CASE("a subvolume is extracted at its place", "[zmc][extract]") {
  const Dims dims{40, 12, 11};
  const std::vector<int> samples = random_samples(dims, 3, 30, 13);
  const std::vector<float> data(samples.begin(), samples.end());
  VolumeView whole = make_view(data.data(), dims, {0.5, 2.0, 0.25}, {8.0, -4.0, 16.0});
  whole.direction << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const Dims lower{3, 2, 4}, upper{36, 11, 9};
  const VolumeView part = subvolume(whole, lower, upper);
  std::vector<float> copy;
  for (std::int64_t k = lower[2]; k < upper[2]; ++k) {
    for (std::int64_t j = lower[1]; j < upper[1]; ++j) {
      for (std::int64_t i = lower[0]; i < upper[0]; ++i) {
        copy.push_back(data[i + dims[0] * (j + dims[1] * k)]);
      }
    }
  }
  VolumeView dense = make_view(copy.data(), {33, 9, 5}, whole.spacing,
                               whole.world(Eigen::Vector3d(3.0, 2.0, 4.0)));
  dense.direction = whole.direction;
  CHECK(same(extract(part, 0.0), extract(dense, 0.0)));
}

TEST_CASE("vertices lie where the view's frame puts them, normals point outwards",
          "[zmc][extract]") {
  const Dims dims{14, 15, 16};
  const std::vector<double> samples = sphere(dims, {6.5, 7.0, 7.5}, 5.3);
  const Mesh lattice = extract(make_view(samples.data(), dims), 0.0);
  const double lattice_volume = properties_of(lattice).volume;
  REQUIRE(lattice_volume > 0.0);
  const double flip = GENERATE(1.0, -1.0);
  const auto inside = GENERATE(Inside::below, Inside::above);
  VolumeView view = make_view(samples.data(), dims, {0.7, 1.3, 2.5}, {-100.0, 33.0, 5.5});
  view.direction = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  view.direction.col(1) *= flip;  // -1: left-handed
  Options options;
  options.inside = inside;
  const Mesh world = extract(view, 0.0, options);
  REQUIRE(world.vertex_count() == lattice.vertex_count());
  double error = 0.0;
  for (std::int64_t v = 0; v < world.vertex_count(); ++v) {
    const Eigen::Vector3d expected = view.world(lattice.V().row(v).transpose());
    error = std::max(error, (expected.transpose() - world.V().row(v)).cwiseAbs().maxCoeff());
  }
  CHECK(error < 1e-11);
  const double scale = 0.7 * 1.3 * 2.5 * (inside == Inside::below ? 1.0 : -1.0);
  const MeshProperties properties = properties_of(world);
  CHECK(properties.is_closed());
  CHECK(properties.volume == Approx(scale * lattice_volume).epsilon(1e-10));
}

TEST_CASE("float positions and 64-bit ids describe the same surface", "[zmc][extract]") {
  const Dims dims{30, 20, 10};
  const int zeros = GENERATE(5, 80);
  const std::vector<int> samples = random_samples(dims, 3, zeros, 14);
  const std::vector<std::int16_t> data(samples.begin(), samples.end());
  const VolumeView view = make_view(data.data(), dims, {0.3, 0.4, 0.5}, {7.0, 8.0, 9.0});
  const Mesh expected = extract(view, 0.0);
  Surface<double, std::int64_t> wide;
  Surface<float, std::int32_t> narrow;
  Surface<float, std::int64_t> both;
  REQUIRE(extract(view, 0.0, {}, wide) == Status::ok);
  REQUIRE(extract(view, 0.0, {}, narrow) == Status::ok);
  REQUIRE(extract(view, 0.0, {}, both) == Status::ok);
  CHECK(wide.positions == expected.positions);
  CHECK(std::equal(wide.indices.begin(), wide.indices.end(), expected.indices.begin(),
                   expected.indices.end()));
  CHECK(narrow.indices == expected.indices);
  CHECK(both.indices == wide.indices);
  CHECK(both.positions == narrow.positions);
  CHECK((narrow.V().cast<double>() - expected.V()).cwiseAbs().maxCoeff() < 2e-6);
}

TEST_CASE("non-manifold edges are counted on request only", "[zmc][extract]") {
  // Two negative quadrants and two positive ones along a line of zeros, which has four sheets.
  constexpr std::int64_t kSide = 5;
  std::vector<std::int16_t> samples;
  for (int k = 0; k < kSide; ++k) {
    for (int j = -2; j <= 2; ++j) {
      for (int i = -2; i <= 2; ++i) samples.push_back(static_cast<std::int16_t>(i * j));
    }
  }
  const VolumeView view = make_view(samples.data(), {kSide, kSide, kSide});
  Options options;
  CHECK(extract(view, 0.0, options).counts.nonmanifold_edges == -1);
  options.count_nonmanifold = true;
  CHECK(extract(view, 0.0, options).counts.nonmanifold_edges == kSide - 1);
}

TEST_CASE("a surface that is filled again equals a new one", "[zmc][extract]") {
  const Dims dims{20, 20, 20};
  Mesh reused;
  for (const int zeros : {90, 0, 60, 97, 30, 100, 5}) {
    const std::vector<int> samples = random_samples(dims, 2, zeros, 15);
    const std::vector<std::int8_t> data(samples.begin(), samples.end());
    const Status status = extract(make_view(data.data(), dims), 0.0, {}, reused);
    CHECK(status == (zeros == 100 ? Status::empty : Status::ok));
    CHECK(same(reused, extract(make_view(data.data(), dims), 0.0)));
  }
}

TEST_CASE("a volume that the isovalue does not divide is empty", "[zmc][extract]") {
  const Dims dims{6, 5, 4};
  for (const double value : {-1.0, 0.0, 1.0}) {
    const std::vector<double> samples(120, value);
    for (const auto mode : {ZeroFaces::boundary, ZeroFaces::mating}) {
      Options options;
      options.zero_faces = mode;
      Mesh mesh;
      CHECK(extract(make_view(samples.data(), dims), 0.0, options, mesh) == Status::empty);
      CHECK(mesh.vertex_count() == 0);
      CHECK(mesh.triangle_count() == 0);
      CHECK(mesh.counts.all_zero_cells == (value == 0.0 ? 60 : 0));
    }
  }
}

TEST_CASE("a solid that fills the volume is capped to a box", "[zmc][extract]") {
  const Dims dims{6, 5, 4};
  const std::vector<double> samples(120, -1.0);
  const auto triangulation = GENERATE(Triangulation::compact, Triangulation::centroid);
  Options options;
  options.triangulation = triangulation;
  options.border = Border::capped;
  const Mesh mesh = extract(make_view(samples.data(), dims), 0.0, options);
  const MeshProperties properties = properties_of(mesh);
  CHECK(properties.is_clean());
  CHECK(properties.is_closed());
  CHECK(properties.nonmanifold_edges == 0);
  CHECK(properties.euler == 2);
  CHECK(properties.volume == Approx(5.0 * 4.0 * 3.0).epsilon(1e-4));
  const double margin = std::ldexp(1.0, -20);
  CHECK(mesh.V().minCoeff() == -margin);
  CHECK(mesh.V().col(0).maxCoeff() == 5.0 + margin);
  options.inside = Inside::above;
  Mesh none;
  CHECK(extract(make_view(samples.data(), dims), 0.0, options, none) == Status::empty);
}

TEST_CASE("centroid triangulation refines the polygons of compact", "[zmc][extract]") {
  const Dims dims{20, 19, 18};
  const std::vector<double> samples = sphere(dims, {9.3, 9.1, 8.7}, 7.1);
  Options options;
  const Mesh compact = extract(make_view(samples.data(), dims), 0.0, options);
  options.triangulation = Triangulation::centroid;
  const Mesh centroid = extract(make_view(samples.data(), dims), 0.0, options);
  CHECK(compact.counts.patches == centroid.counts.patches);
  CHECK(compact.counts.centroids == 0);
  CHECK(centroid.counts.centroids == centroid.vertex_count() - compact.vertex_count());
  // n triangles instead of n - 2 for each polygon with a centroid.
  CHECK(centroid.triangle_count() == compact.triangle_count() + 2 * centroid.counts.centroids);
}

TEST_CASE("a surface of too many vertices is only counted", "[zmc][extract]") {
  const Dims dims{20, 20, 20};
  const std::vector<double> samples = sphere(dims, {9.5, 9.5, 9.5}, 7.0);
  const auto view = make_view(samples.data(), dims);
  const Mesh whole = extract(view, 0.0);
  Options options;
  options.max_vertices = whole.vertex_count();
  Mesh mesh;
  CHECK(extract(view, 0.0, options, mesh) == Status::ok);
  options.max_vertices = whole.vertex_count() - 1;
  CHECK(extract(view, 0.0, options, mesh) == Status::too_many_vertices);
  CHECK(mesh.vertex_count() == 0);
  CHECK(mesh.triangle_count() == 0);
  CHECK(mesh.counts.patches == whole.counts.patches);
  CHECK(mesh.counts.cells_with_patch == whole.counts.cells_with_patch);
  CHECK_THROWS_AS(extract(view, 0.0, options), std::length_error);
}

TEST_CASE("progress rises to one and can cancel", "[zmc][extract]") {
  const Dims dims{60, 60, 60};
  const std::vector<double> samples = sphere(dims, {30, 30, 30}, 25.5);
  const auto view = make_view(samples.data(), dims);
  std::vector<double> shares;
  Options options;
  options.progress = [&](double share) {
    shares.push_back(share);
    return true;
  };
  Mesh mesh;
  REQUIRE(extract(view, 0.0, options, mesh) == Status::ok);
  REQUIRE_FALSE(shares.empty());
  CHECK(std::is_sorted(shares.begin(), shares.end()));
  CHECK(shares.front() >= 0.0);
  CHECK(shares.back() <= 1.0);
  for (std::size_t stop = 0; stop < shares.size(); ++stop) {
    std::size_t calls = 0;
    options.progress = [&](double) { return calls++ != stop; };
    const Status status = extract(view, 0.0, options, mesh);
    INFO("cancelled at call " << stop);
    // Threads may share the work in fewer reports than before; at least one is always made.
    if (calls <= stop) {
      CHECK(stop > 0);
      CHECK(status == Status::ok);
      continue;
    }
    CHECK(status == Status::cancelled);
    CHECK(mesh.vertex_count() == 0);
    CHECK(mesh.triangle_count() == 0);
    CHECK(calls == stop + 1);
  }
  options.progress = [](double) { return false; };
  CHECK_THROWS_AS(extract(view, 0.0, options), std::runtime_error);
}

TEST_CASE("extract names what it refuses", "[zmc][contract]") {
  std::vector<double> samples(27, 1.0);
  samples[13] = -1.0;
  const auto view = make_view(samples.data(), {3, 3, 3});
  Mesh mesh;
  const auto message = [&](const VolumeView& v, double isovalue, const Options& options) {
    try {
      extract(v, isovalue, options, mesh);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  using Catch::Matchers::Contains;
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    CHECK_THAT(message(view, bad, {}), Contains("isovalue"));
  }
  Options options;
  options.threads = -1;
  CHECK_THAT(message(view, 0.0, options), Contains("threads") && Contains("-1"));
  options = {};
  options.max_vertices = -5;
  CHECK_THAT(message(view, 0.0, options), Contains("max_vertices") && Contains("-5"));
  VolumeView thin = view;
  thin.dims = {3, 9, 1};
  CHECK_THAT(message(thin, 0.0, {}), Contains("1"));
  CHECK_THROWS_AS(extract(thin, 0.0, {}, mesh), std::invalid_argument);
  VolumeView flat = view;
  flat.direction.col(2) = flat.direction.col(1);
  CHECK_THROWS_AS(extract(flat, 0.0, {}, mesh), std::invalid_argument);
}

TEST_CASE("the first sample that is not finite is named, or masked and counted",
          "[zmc][contract]") {
  const Dims dims{70, 6, 5};
  const double bad =
      GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
               -std::numeric_limits<double>::infinity());
  const Dims at = GENERATE(Dims{0, 0, 0}, Dims{69, 5, 4}, Dims{65, 3, 2}, Dims{64, 0, 4});
  const std::vector<int> integers = random_samples(dims, 3, 20, 16);
  std::vector<float> samples(integers.begin(), integers.end());
  const auto place = [&](const Dims& p) -> float& {
    return samples[p[0] + dims[0] * (p[1] + dims[1] * p[2])];
  };
  place(at) = static_cast<float>(bad);
  if (at != Dims{69, 5, 4}) place({69, 5, 4}) = std::nanf("");
  const auto view = make_view(samples.data(), dims);
  const int threads = GENERATE(1, 2);
  Options options;
  options.threads = threads;
  Mesh mesh;
  std::string text;
  try {
    extract(view, 0.0, options, mesh);
  } catch (const std::invalid_argument& error) {
    text = error.what();
  }
  INFO(text);
  for (const std::int64_t index : at) {
    CHECK(text.find(std::to_string(index)) != std::string::npos);
  }
  options.non_finite = NonFinite::mask;
  CHECK(extract(view, 0.0, options, mesh) == Status::ok);
  CHECK(mesh.counts.masked_cells > 0);
  CHECK(mesh.V().allFinite());
}

TEST_CASE("a volume of samples that are not finite has no surface", "[zmc][extract]") {
  const std::vector<double> samples(64, std::nan(""));
  Options options;
  options.non_finite = NonFinite::mask;
  Mesh mesh;
  CHECK(extract(make_view(samples.data(), {4, 4, 4}), 0.0, options, mesh) == Status::empty);
  CHECK(mesh.counts.masked_cells == 27);
}
}  // namespace
