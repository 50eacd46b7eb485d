// Random volumes: what must hold for every surface, and equality with the reference.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "shape3d/zmc/extract.hpp"
#include "support/random_volume.hpp"
#include "surface_set.hpp"

namespace {
using namespace shape3d::zmc;
using namespace shape3d::zmc::test;
using shape3d::test::random_samples;

using Dims = std::array<std::int64_t, 3>;

reference::Volume volume_of(const Dims& dims, const std::vector<int>& samples) {
  return {dims, std::vector<double>(samples.begin(), samples.end())};
}

VolumeView view_of(const reference::Volume& volume) {
  return make_view(volume.samples.data(), volume.dims);
}

template <class Real, class Index>
bool same_bytes(const Surface<Real, Index>& a, const Surface<Real, Index>& b) {
  return a.positions.size() == b.positions.size() && a.indices.size() == b.indices.size() &&
         (a.positions.empty() || std::memcmp(a.positions.data(), b.positions.data(),
                                             a.positions.size() * sizeof(Real)) == 0) &&
         (a.indices.empty() ||
          std::memcmp(a.indices.data(), b.indices.data(), a.indices.size() * sizeof(Index)) == 0) &&
         a.first_zero_face == b.first_zero_face && a.first_closing == b.first_closing;
}

using Mesh = Surface<double, std::int32_t>;

/// Row by row the same triangles with the second and third vertex exchanged.
bool is_reversed(const Mesh& a, const Mesh& b) {
  if (a.triangle_count() != b.triangle_count()) return false;
  for (std::int64_t f = 0; f < a.triangle_count(); ++f) {
    const auto s = a.F().row(f), t = b.F().row(f);
    if (s[0] != t[0] || s[1] != t[2] || s[2] != t[1]) return false;
  }
  return true;
}

std::string text(const Options& options, const Dims& dims) {
  return std::to_string(dims[0]) + "x" + std::to_string(dims[1]) + "x" + std::to_string(dims[2]) +
         (options.ties == TieRule::neutral ? " neutral" : " positive") +
         (options.triangulation == Triangulation::compact ? " compact" : " centroid") +
         (options.zero_faces == ZeroFaces::boundary ? " boundary" : " mating") +
         (options.inside == Inside::below ? " below" : " above") +
         (options.border == Border::open ? " open" : " capped") +
         (options.non_finite == NonFinite::error ? "" : " mask") + " threads " +
         std::to_string(options.threads);
}

/// The reference's surface for the library's options; the lattice is that of `named`, which has one
/// more layer of samples all round when capped.
struct Expected {
  reference::Volume named;
  reference::Result result;
  int outside = 0;
};
Expected expected_of(const reference::Volume& volume, const Options& options) {
  Expected expected;
  expected.named = options.inside == Inside::above ? negated(volume) : volume;
  if (options.border == Border::capped) {
    // Far outside: larger than any sample by more than 2^20, so that the crossing is clamped.
    expected.named = padded(expected.named, 1e300);
    expected.outside = 1;
  }
  expected.result = reference::extract(
      expected.named,
      {options.ties == TieRule::neutral ? reference::Ties::neutral : reference::Ties::positive,
       options.zero_faces == ZeroFaces::mating});
  return expected;
}

void check_equal(const reference::SurfaceSet& expected, const reference::SurfaceSet& got) {
  CHECK(got.patches.size() == expected.patches.size());
  CHECK(got.zero_faces.size() == expected.zero_faces.size());
  CHECK(got.closing.size() == expected.closing.size());
  CHECK((got.patches == expected.patches));
  CHECK((got.zero_faces == expected.zero_faces));
  CHECK((got.closing == expected.closing));
}

void check_counts(const Counts& counts, const Expected& expected, const Conversion& conversion,
                  const MeshProperties& properties, bool open) {
  const auto& [surface, census] = expected.result;
  CHECK(counts.patches == static_cast<std::int64_t>(surface.patches.size()));
  CHECK(counts.zero_faces == static_cast<std::int64_t>(surface.zero_faces.size()));
  CHECK(counts.closing_triangles == static_cast<std::int64_t>(surface.closing.size()));
  CHECK(counts.zero_vertices == conversion.zero_vertices);
  CHECK(counts.centroids == conversion.centroids);
  CHECK(counts.nonmanifold_edges == properties.nonmanifold_edges);
  CHECK(counts.all_zero_cells == census.all_zero_cells);
  CHECK(counts.cells_with_patch == census.cells_with_patch);
  CHECK(counts.faces_by_case == census.faces_by_case);
  if (open) CHECK(counts.masked_cells == census.masked_cells);
}

/// Everything that section 3.b of the library's contract promises of one volume.
void check_volume(const reference::Volume& volume, Options options) {
  options.count_nonmanifold = true;
  INFO(text(options, volume.dims));
  Mesh surface;
  const Status status = extract(view_of(volume), 0.0, options, surface);
  const Expected expected = expected_of(volume, options);
  const reference::SurfaceSet& want = expected.result.surface;
  const bool nothing = want.patches.empty() && want.zero_faces.empty() && want.closing.empty();
  REQUIRE(status == (nothing ? Status::empty : Status::ok));

  const bool open = options.border == Border::open;
  const MeshProperties properties =
      properties_of(surface, open ? at_border_or_mask(volume) : shape3d::test::Exempt{});
  CHECK(properties.is_clean());
  if (options.zero_faces == ZeroFaces::boundary) {
    CHECK(properties.odd_edges == 0);
    CHECK(properties.unbalanced_edges == 0);
    CHECK(properties.inconsistent_edges == 0);
  }
  try {
    const Conversion conversion = convert(surface, expected.named, expected.outside);
    check_equal(want, conversion.surface);
    CHECK(conversion.position_error < 1e-12);
    CHECK(std::is_sorted(conversion.triangle_cells.begin(), conversion.triangle_cells.end()));
    check_counts(surface.counts, expected, conversion, properties, open);
  } catch (const std::runtime_error& error) {
    FAIL_CHECK(error.what());
  }

  Mesh other;
  const reference::Volume negative = negated(volume);
  if (options.ties == TieRule::neutral && open) {
    REQUIRE(extract(view_of(negative), 0.0, options, other) == status);
    CHECK(other.positions == surface.positions);
    CHECK(is_reversed(surface, other));
  }
  // Inside::above of the negated samples is Inside::below of the samples.
  Options above = options;
  above.inside = options.inside == Inside::below ? Inside::above : Inside::below;
  REQUIRE(extract(view_of(negative), 0.0, above, other) == status);
  CHECK(same_bytes(surface, other));

  for (const int threads : {1, 2, 3}) {
    options.threads = threads;
    REQUIRE(extract(view_of(volume), 0.0, options, other) == status);
    INFO("threads " << threads);
    CHECK(same_bytes(surface, other));
  }
}

TEST_CASE("random volumes: closed, clean, neutral and equal to the reference", "[zmc][random]") {
  const int zeros = GENERATE(0, 5, 30, 60, 80, 90, 97);
  const int magnitude = GENERATE(1, 3, 100);
  const auto ties = GENERATE(TieRule::neutral, TieRule::positive);
  const auto triangulation = GENERATE(Triangulation::compact, Triangulation::centroid);
  INFO("zeros " << zeros << " %, magnitude " << magnitude);
  Options options;
  options.ties = ties;
  options.triangulation = triangulation;
  std::uint64_t seed = 100;
  for (const Dims& dims : {Dims{2, 2, 2}, Dims{3, 2, 4}, Dims{9, 10, 7}, Dims{17, 16, 18}}) {
    check_volume(volume_of(dims, random_samples(dims, magnitude, zeros, seed++)), options);
  }
}

TEST_CASE("random volumes with rows round the widths of machine words", "[zmc][random]") {
  const std::int64_t length =
      GENERATE(2, 3, 31, 32, 33, 34, 63, 64, 65, 66, 127, 128, 129, 130, 257);
  const int zeros = GENERATE(0, 30, 90);
  INFO("zeros " << zeros << " %");
  const Dims dims{length, 5, 6};
  check_volume(volume_of(dims, random_samples(dims, 2, zeros, 40 + length)), {});
}

TEST_CASE("random volumes in mating mode equal the reference", "[zmc][random]") {
  const int zeros = GENERATE(30, 60, 80, 90, 97);
  const auto triangulation = GENERATE(Triangulation::compact, Triangulation::centroid);
  Options options;
  options.zero_faces = ZeroFaces::mating;
  options.triangulation = triangulation;
  INFO("zeros " << zeros << " %");
  const Dims dims{12, 11, 10};
  check_volume(volume_of(dims, random_samples(dims, 2, zeros, 50 + zeros)), options);
}

TEST_CASE("random volumes with the inside above", "[zmc][random]") {
  const int zeros = GENERATE(0, 30, 80);
  const auto ties = GENERATE(TieRule::neutral, TieRule::positive);
  Options options;
  options.inside = Inside::above;
  options.ties = ties;
  INFO("zeros " << zeros << " %");
  const Dims dims{12, 11, 10};
  check_volume(volume_of(dims, random_samples(dims, 2, zeros, 60 + zeros)), options);
}

TEST_CASE("random capped volumes are closed at the border too", "[zmc][random]") {
  const int zeros = GENERATE(0, 30, 80, 97);
  const auto inside = GENERATE(Inside::below, Inside::above);
  const auto triangulation = GENERATE(Triangulation::compact, Triangulation::centroid);
  Options options;
  options.border = Border::capped;
  options.inside = inside;
  options.triangulation = triangulation;
  INFO("zeros " << zeros << " %");
  for (const Dims& dims : {Dims{2, 2, 2}, Dims{9, 8, 10}, Dims{64, 5, 4}}) {
    check_volume(volume_of(dims, random_samples(dims, 2, zeros, 70 + zeros)), options);
  }
}

TEST_CASE("random volumes with masked samples equal the reference", "[zmc][random]") {
  const int zeros = GENERATE(0, 30, 80);
  const int every = GENERATE(7, 100);
  Options options;
  options.non_finite = NonFinite::mask;
  const Dims dims{13, 12, 11};
  reference::Volume volume = volume_of(dims, random_samples(dims, 2, zeros, 80 + zeros));
  constexpr std::array<double, 3> kNonFinite{std::numeric_limits<double>::quiet_NaN(),
                                             std::numeric_limits<double>::infinity(),
                                             -std::numeric_limits<double>::infinity()};
  for (std::size_t n = 3; n < volume.samples.size(); n += every) {
    volume.samples[n] = kNonFinite[n % 3];
  }
  INFO("zeros " << zeros << " %, every " << every << "th sample masked");
  check_volume(volume, options);
}

TEST_CASE("random volumes of magnitudes 2^-100 to 2^100 have no coincident vertices",
          "[zmc][random]") {
  const int zeros = GENERATE(0, 30, 90);
  const auto triangulation = GENERATE(Triangulation::compact, Triangulation::centroid);
  Options options;
  options.triangulation = triangulation;
  const Dims dims{15, 14, 13};
  reference::Volume volume = volume_of(dims, random_samples(dims, 201, zeros, 90 + zeros));
  for (double& s : volume.samples) {
    if (s != 0.0) s = std::copysign(std::ldexp(1.0, static_cast<int>(std::abs(s)) - 101), s);
  }
  INFO("zeros " << zeros << " %");
  check_volume(volume, options);
}

TEST_CASE("random volumes at the ends of the range of double are closed and neutral",
          "[zmc][random]") {
  // Products overflow or vanish, and all count as equal: the reference decides otherwise, but the
  // surface must be whole.
  const int zeros = GENERATE(0, 30, 80);
  const int exponent = GENERATE(-1070, -700, 600, 1020);
  const Dims dims{13, 12, 11};
  reference::Volume volume = volume_of(dims, random_samples(dims, 5, zeros, 95 + zeros));
  for (double& s : volume.samples) s = std::ldexp(s, exponent);
  INFO("zeros " << zeros << " %, exponent " << exponent);
  const Mesh mesh = extract(view_of(volume), 0.0);
  const MeshProperties properties = properties_of(mesh, at_border_or_mask(volume));
  CHECK(properties.is_clean());
  CHECK(properties.is_closed());
  const reference::Volume negative = negated(volume);
  const Mesh other = extract(view_of(negative), 0.0);
  CHECK(other.positions == mesh.positions);
  CHECK(is_reversed(mesh, other));
}

TEST_CASE("a large random volume is the same for any number of threads", "[zmc][random]") {
  const int zeros = GENERATE(5, 80);
  const Dims dims{90, 70, 61};
  const std::vector<int> samples = random_samples(dims, 2, zeros, 3);
  const std::vector<std::int16_t> narrow(samples.begin(), samples.end());
  Options options;
  options.threads = 1;
  Mesh one;
  REQUIRE(extract(make_view(narrow.data(), dims), 0.0, options, one) == Status::ok);
  const MeshProperties properties = properties_of(one, shape3d::test::on_border(dims));
  CHECK(properties.is_clean());
  CHECK(properties.is_closed());
  Mesh other;
  for (const int threads : {0, 2, 3, 4, 7, 64}) {
    options.threads = threads;
    REQUIRE(extract(make_view(narrow.data(), dims), 0.0, options, other) == Status::ok);
    INFO("threads " << threads);
    CHECK(same_bytes(one, other));
  }
}

TEST_CASE("large random volumes equal the reference", "[zmc][random]") {
  const int zeros = GENERATE(0, 5, 30, 60, 80, 90, 97);
  const Dims dims{40, 30, 26};
  INFO("zeros " << zeros << " %");
  check_volume(volume_of(dims, random_samples(dims, 1, zeros, 17)), {});
}
}  // namespace
