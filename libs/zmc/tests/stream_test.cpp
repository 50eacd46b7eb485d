#include "shape3d/zmc/stream.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <vector>

#include <catch2/catch.hpp>

#include "shape3d/zmc/extract.hpp"
#include "support/random_volume.hpp"

namespace {

using namespace shape3d::zmc;
using shape3d::test::random_samples;
using Dims = std::array<std::int64_t, 3>;
using Whole = Surface<double, std::int64_t>;

/// A source over samples in memory that insists on the promised order of reading.
template <class T>
PlaneSource source_of(const std::vector<T>& samples, const Dims& dims, std::int64_t& next_plane) {
  PlaneSource source;
  source.type = SampleTypeOf<T>::value;
  source.dims = dims;
  source.spacing = {0.5, 0.75, 2.0};
  source.origin = {-3.0, 7.0, 11.0};
  source.read = [&samples, dims, &next_plane](std::int64_t first, std::int64_t count, void* out) {
    if (first == 0) next_plane = 0;
    REQUIRE(first == next_plane);
    REQUIRE(first + count <= dims[2]);
    next_plane = first + count;
    const std::size_t plane = static_cast<std::size_t>(dims[0] * dims[1]);
    std::memcpy(out, samples.data() + static_cast<std::size_t>(first) * plane,
                static_cast<std::size_t>(count) * plane * sizeof(T));
  };
  return source;
}

VolumeView view_of(const PlaneSource& source, const void* samples) {
  VolumeView view;
  view.data = samples;
  view.type = source.type;
  view.dims = source.dims;
  view.spacing = source.spacing;
  view.origin = source.origin;
  view.direction = source.direction;
  return view;
}

/// Everything that stream() delivered, joined.
struct Joined {
  std::vector<double> positions, normals;
  std::array<std::vector<std::array<std::int64_t, 3>>, 3> triangles;  ///< By kind.
  Counts counts;
  Status status = Status::ok;
};

Joined join(const PlaneSource& source, double isovalue, const Options& options,
            std::int64_t planes) {
  Joined all;
  StreamOptions stream_options;
  stream_options.planes_per_slab = planes;
  all.status = stream<double>(
      source, isovalue, options, stream_options,
      [&](const Whole& slab, std::int64_t first_id) {
        REQUIRE(first_id == static_cast<std::int64_t>(all.positions.size() / 3));
        all.positions.insert(all.positions.end(), slab.positions.begin(), slab.positions.end());
        all.normals.insert(all.normals.end(), slab.normals.begin(), slab.normals.end());
        for (std::int64_t t = 0; t < slab.triangle_count(); ++t) {
          all.triangles[static_cast<std::size_t>(slab.kind(t))].push_back(
              {slab.F()(t, 0), slab.F()(t, 1), slab.F()(t, 2)});
        }
        return true;
      },
      &all.counts);
  return all;
}

void check_equal(const Joined& joined, const Whole& whole) {
  REQUIRE(joined.positions.size() == whole.positions.size());
  CHECK(std::equal(joined.positions.begin(), joined.positions.end(), whole.positions.begin()));
  CHECK(std::equal(joined.normals.begin(), joined.normals.end(), whole.normals.begin(),
                   whole.normals.end()));
  std::array<std::vector<std::array<std::int64_t, 3>>, 3> triangles;
  for (std::int64_t t = 0; t < whole.triangle_count(); ++t) {
    triangles[static_cast<std::size_t>(whole.kind(t))].push_back(
        {whole.F()(t, 0), whole.F()(t, 1), whole.F()(t, 2)});
  }
  CHECK(joined.triangles == triangles);
  const Counts &a = joined.counts, &b = whole.counts;
  CHECK(a.cells_with_patch == b.cells_with_patch);
  CHECK(a.faces_by_case == b.faces_by_case);
  CHECK(a.patches == b.patches);
  CHECK(a.zero_vertices == b.zero_vertices);
  CHECK(a.zero_faces == b.zero_faces);
  CHECK(a.closing_triangles == b.closing_triangles);
  CHECK(a.all_zero_cells == b.all_zero_cells);
  CHECK(a.masked_cells == b.masked_cells);
  CHECK(a.centroids == b.centroids);
  CHECK(a.nonmanifold_edges == b.nonmanifold_edges);
}

TEST_CASE("slabs together are the surface of the whole volume", "[zmc][stream]") {
  const Dims dims{13, 9, 23};
  for (const int density : {0, 5, 30, 60, 90, 97}) {
    const std::vector<int> random = random_samples(dims, 3, density, 40 + density);
    const std::vector<std::int16_t> samples(random.begin(), random.end());
    std::int64_t next_plane = 0;
    const PlaneSource source = source_of(samples, dims, next_plane);
    for (const Triangulation triangulation : {Triangulation::compact, Triangulation::centroid}) {
      Options options;
      options.triangulation = triangulation;
      options.normals = true;
      options.threads = 2;
      options.count_nonmanifold = density != 60;
      Whole whole;
      extract(view_of(source, samples.data()), 0.0, options, whole);
      for (const std::int64_t planes : {1, 2, 5, 11, 22, 23, 0}) {
        INFO("zeros " << density << " %, " << planes << " planes a slab");
        check_equal(join(source, 0.0, options, planes), whole);
      }
    }
  }
}

TEST_CASE("slabs of a capped volume, its caps among them", "[zmc][stream]") {
  const Dims dims{9, 7, 14};
  for (const int density : {0, 30, 90, 97}) {
    const std::vector<int> random = random_samples(dims, 3, density, 60 + density);
    std::vector<float> samples(random.begin(), random.end());
    for (const bool masked : {false, true}) {
      for (std::size_t n = 5; masked && n < samples.size(); n += 97)
        samples[n] = std::numeric_limits<float>::quiet_NaN();
      std::int64_t next_plane = 0;
      PlaneSource source = source_of(samples, dims, next_plane);
      for (const Inside inside : {Inside::below, Inside::above}) {
        for (const ZeroFaces zero_faces : {ZeroFaces::boundary, ZeroFaces::mating}) {
          Options options;
          options.border = Border::capped;
          options.inside = inside;
          options.zero_faces = zero_faces;
          options.normals = true;
          options.non_finite = NonFinite::mask;
          Whole whole;
          extract(view_of(source, samples.data()), 0.0, options, whole);
          // The caps: vertices outside the first and the last plane, where negative samples are.
          if (density <= 30) REQUIRE(whole.V().col(2).minCoeff() < source.origin[2]);
          if (density <= 30)
            REQUIRE(whole.V().col(2).maxCoeff() >
                    source.origin[2] + 2.0 * static_cast<double>(dims[2] - 1));
          for (const std::int64_t planes : {1, 2, 3, 7, 14, 15, 16, 0}) {
            INFO("zeros " << density << " %, " << planes << " planes a slab");
            source.can_be_read_twice = true;
            check_equal(join(source, 0.0, options, planes), whole);
            source.can_be_read_twice = false;
            const Joined once = join(source, 0.0, options, planes);
            if (once.status == Status::zero_region_at_seam) continue;
            check_equal(once, whole);
          }
        }
      }
    }
  }
}

TEST_CASE("slabs of a volume with masked samples", "[zmc][stream]") {
  const Dims dims{10, 8, 12};
  const std::vector<int> random = random_samples(dims, 3, 20, 77);
  std::vector<float> samples(random.begin(), random.end());
  for (std::size_t n = 5; n < samples.size(); n += 97)
    samples[n] = std::numeric_limits<float>::quiet_NaN();
  std::int64_t next_plane = 0;
  const PlaneSource source = source_of(samples, dims, next_plane);
  Options options;
  CHECK_THROWS_WITH(join(source, 0.0, options, 3), Catch::Contains("(5, 0, 0)"));
  options.non_finite = NonFinite::mask;
  Whole whole;
  extract(view_of(source, samples.data()), 0.0, options, whole);
  REQUIRE(whole.counts.masked_cells > 0);
  for (const std::int64_t planes : {1, 3, 12})
    check_equal(join(source, 0.0, options, planes), whole);
  std::fill(samples.begin(), samples.end(), 1.0f);
  samples[static_cast<std::size_t>(dims[0] * dims[1] * 9 + 4)] =
      std::numeric_limits<float>::infinity();
  CHECK_THROWS_WITH(join(source, 0.0, Options{}, 2), Catch::Contains("got inf at (4, 0, 9)"));
}

TEST_CASE("a source read once ends where a zero region meets a seam", "[zmc][stream]") {
  const Dims dims{6, 6, 12};
  std::vector<double> samples(6 * 6 * 12);
  const auto fill = [&](std::int64_t first_zero, std::int64_t last_zero) {
    for (std::int64_t k = 0; k < dims[2]; ++k) {
      const double value = k < first_zero ? -1.0 : k > last_zero ? 1.0 : 0.0;
      std::fill_n(samples.begin() + 36 * k, 36, value);
    }
  };
  std::int64_t next_plane = 0;
  PlaneSource source = source_of(samples, dims, next_plane);
  source.can_be_read_twice = false;
  fill(5, 7);  // cells of eight zeros in layers 5 and 6
  CHECK(join(source, 0.0, Options{}, 6).status == Status::zero_region_at_seam);
  CHECK(join(source, 0.0, Options{}, 12).status == Status::ok);
  fill(2, 4);  // layers 2 and 3; seams at 6
  const Joined joined = join(source, 0.0, Options{}, 6);
  CHECK(joined.status == Status::ok);
  Whole whole;
  extract(view_of(source, samples.data()), 0.0, Options{}, whole);
  REQUIRE(whole.counts.zero_faces == 25);
  check_equal(joined, whole);
}

TEST_CASE("a stream can be cancelled and limited", "[zmc][stream]") {
  const Dims dims{8, 8, 16};
  const std::vector<int> random = random_samples(dims, 3, 10, 3);
  const std::vector<double> samples(random.begin(), random.end());
  std::int64_t next_plane = 0;
  const PlaneSource source = source_of(samples, dims, next_plane);
  const auto accept = [](const Whole&, std::int64_t) { return true; };
  StreamOptions by_four;
  by_four.planes_per_slab = 4;
  Options options;
  std::vector<double> shares;
  options.progress = [&](double share) {
    shares.push_back(share);
    return true;
  };
  CHECK(stream<double>(source, 0.0, options, by_four, accept) == Status::ok);
  REQUIRE(shares.size() == 8);
  CHECK(std::is_sorted(shares.begin(), shares.end()));
  CHECK(shares.back() == Approx(1.0));
  for (std::size_t stop = 0; stop < 8; ++stop) {
    std::size_t calls = 0;
    options.progress = [&](double) { return calls++ != stop; };
    CHECK(stream<double>(source, 0.0, options, by_four, accept) == Status::cancelled);
  }
  CHECK(stream<double>(source, 0.0, Options{}, by_four,
                       [](const Whole&, std::int64_t) { return false; }) == Status::cancelled);
  Options limited;
  limited.max_vertices = 100;
  CHECK(stream<double>(source, 0.0, limited, by_four, accept) == Status::too_many_vertices);
  CHECK(stream<double>(source, 99.0, Options{}, by_four, accept) == Status::empty);
}

TEST_CASE("stream names what it refuses", "[zmc][contract]") {
  const std::vector<double> samples(4 * 4 * 4, 1.0);
  std::int64_t next_plane = 0;
  PlaneSource source = source_of(samples, Dims{4, 4, 4}, next_plane);
  const auto accept = [](const Whole&, std::int64_t) { return true; };
  Options edges;
  edges.edges = true;
  CHECK_THROWS_WITH(stream<double>(source, 0.0, edges, {}, accept),
                    Catch::Contains("options.edges"));
  StreamOptions negative;
  negative.planes_per_slab = -2;
  CHECK_THROWS_WITH(stream<double>(source, 0.0, Options{}, negative, accept),
                    Catch::Contains("planes_per_slab") && Catch::Contains("-2"));
  source.dims[1] = 1;
  CHECK_THROWS_AS(stream<double>(source, 0.0, Options{}, {}, accept), std::invalid_argument);
  source.dims[1] = 4;
  source.read = nullptr;
  CHECK_THROWS_WITH(stream<double>(source, 0.0, Options{}, {}, accept),
                    Catch::Contains("source.read"));
}

}  // namespace
