// The compact form of progressive meshes.
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <catch2/catch.hpp>

#include "bodies.hpp"
#include "shape3d/mapping/inspect.hpp"
#include "shape3d/mapping/progressive.hpp"

namespace {
using namespace shape3d::mapping;
using namespace shape3d::mapping::test;
using Catch::Matchers::Contains;
using Bytes = std::vector<std::byte>;

bool same_bits(const Points& a, const Points& b) {
  return a.rows() == b.rows() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

Body rough(int level, unsigned seed) {
  std::mt19937 random(seed);
  Body body = shuffled(sphere(level), random);
  std::normal_distribution<double> noise(1.0, 0.05);
  for (Eigen::Index v = 0; v < body.V.rows(); ++v) body.V.row(v) *= noise(random);
  return body;
}

ProgressiveMesh read(const Bytes& bytes) {
  return ProgressiveMesh::from_bytes(bytes.data(), bytes.size());
}

// All levels are equal.
void check_equal(ProgressiveMesh a, ProgressiveMesh b) {
  REQUIRE(a.finest() == b.finest());
  REQUIRE(a.coarsest() == b.coarsest());
  REQUIRE(a.collapses() == b.collapses());
  for (std::int64_t n = a.finest(); n >= a.coarsest(); n -= 1 + a.finest() / 40) {
    a.set_triangle_count(n);
    b.set_triangle_count(n);
    REQUIRE(same_bits(a.V(), b.V()));
    REQUIRE(a.F() == b.F());
    REQUIRE(a.vertex_rows() == b.vertex_rows());
  }
}

TEST_CASE("bytes hold all levels to the bit", "[mapping][progressive][bytes]") {
  const auto rounded = [](Points V, double unit) {
    for (Eigen::Index i = 0; i < V.size(); ++i) V.data()[i] = std::round(V.data()[i] * unit) / unit;
    return V;
  };
  const Body body = rough(3, 6);
  Points mixed = body.V;  // of all kinds
  mixed(0, 0) = -0.0;
  mixed(1, 1) = std::numeric_limits<double>::denorm_min();
  mixed(2, 2) = 1e-200;
  const struct {
    const char* name;
    Points V;
    double bytes_per_vertex;
  } kinds[] = {{"all bits", body.V, 50},
               {"six decimals", rounded(body.V, 1e6), 30},
               {"whole numbers", rounded(1000 * body.V, 1), 26},
               {"floats", body.V.cast<float>().cast<double>(), 34},
               {"of all kinds", mixed, 52},
               {"large", 1e200 * body.V, 50},
               {"far away", rounded((body.V.array() + 1e6).matrix(), 1024), 30}};
  for (const auto& kind : kinds) {
    INFO(kind.name);
    const ProgressiveMesh mesh(kind.V, body.F);
    const Bytes bytes = mesh.to_bytes();
    const ProgressiveMesh again = read(bytes);
    CHECK(same_bits(again.V(), kind.V));
    CHECK(again.F() == body.F);
    check_equal(mesh, again);
    CHECK((again.to_bytes() == bytes));  // no print of thousands of bytes
    const double size = static_cast<double>(bytes.size()) / static_cast<double>(kind.V.rows());
    INFO(size << " bytes a vertex; coordinates and indices alone are 48");
    CHECK(size < kind.bytes_per_vertex);
  }
}

TEST_CASE("bytes of meshes with boundary, handles and pieces", "[mapping][progressive][bytes]") {
  const Body sheet = patch(14, [](double x, double y) { return 0.2 * std::cos(3 * x * y); });
  Triangles holed(sheet.F.rows() - 2, 3);
  holed << sheet.F.topRows(150), sheet.F.bottomRows(sheet.F.rows() - 152);
  check_equal(ProgressiveMesh(sheet.V, holed), read(ProgressiveMesh(sheet.V, holed).to_bytes()));
  const Body ring = torus(2, 0.7, 30, 14);
  check_equal(ProgressiveMesh(ring.V, ring.F), read(ProgressiveMesh(ring.V, ring.F).to_bytes()));
  const Body a = sphere(1), b = sphere(2);
  Points V(a.V.rows() + b.V.rows(), 3);
  V << a.V, b.V.array() + 3;
  Triangles F(a.F.rows() + b.F.rows(), 3);
  F << a.F, b.F.array() + static_cast<std::int32_t>(a.V.rows());
  ProgressiveOptions options;
  options.cost = CollapseCost::lindstrom_turk;
  const ProgressiveMesh both(V, F, options);
  check_equal(both, read(both.to_bytes()));
  Points corner(3, 3);
  corner << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  Triangles one(1, 3);
  one << 2, 0, 1;
  check_equal(ProgressiveMesh(corner, one), read(ProgressiveMesh(corner, one).to_bytes()));
}

TEST_CASE("the present level does not matter to the bytes", "[mapping][progressive][bytes]") {
  const Body body = rough(2, 3);
  ProgressiveMesh mesh(body.V, body.F);
  const Bytes bytes = mesh.to_bytes();
  mesh.set_triangle_count(100);
  CHECK((mesh.to_bytes() == bytes));
  CHECK(mesh.triangle_count() == 100);
  CHECK(read(bytes).triangle_count() == body.F.rows());
}

TEST_CASE("damaged bytes are refused", "[mapping][progressive][bytes][contract]") {
  const Body body = rough(2, 9);
  const Bytes bytes = ProgressiveMesh(body.V, body.F).to_bytes();
  CHECK_THROWS_WITH(read({}), Contains("do not begin with S3DPROG1"));
  CHECK_THROWS_WITH(read(Bytes(100, std::byte{7})), Contains("do not begin with S3DPROG1"));
  Bytes cut(bytes.begin(), bytes.end() - 1);
  CHECK_THROWS_WITH(read(cut), Contains("the checksum does not fit"));
  Bytes flipped = bytes;
  flipped[bytes.size() / 2] ^= std::byte{4};
  CHECK_THROWS_WITH(read(flipped), Contains("the checksum does not fit"));
}

std::uint64_t fnv(const std::byte* data, std::size_t size) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (std::size_t i = 0; i < size; ++i)
    hash = (hash ^ static_cast<std::uint64_t>(data[i])) * 1099511628211ULL;
  return hash;
}

TEST_CASE("damaged bytes with a good checksum end in an error or a manifold",
          "[mapping][progressive][bytes][contract]") {
  std::mt19937 random(12);
  const Body body = rough(1, 9);
  const Body sheet = patch(5, [](double x, double y) { return x * y; });
  int refused = 0, read_back = 0;
  for (const Bytes& good :
       {ProgressiveMesh(body.V, body.F).to_bytes(), ProgressiveMesh(sheet.V, sheet.F).to_bytes()}) {
    for (int trial = 0; trial < 4000; ++trial) {
      Bytes bad = good;
      const std::size_t size = bad.size() - 8;
      for (auto changes = 1 + random() % 3; changes > 0; --changes)
        bad[8 + random() % (size - 8)] = static_cast<std::byte>(random() % 256);
      std::size_t end = size;
      if (random() % 8 == 0) end = 8 + random() % (size - 8);  // cut short
      bad.resize(end + 8);
      const std::uint64_t hash = fnv(bad.data(), end);
      for (std::size_t i = 0; i < 8; ++i) bad[end + i] = static_cast<std::byte>(hash >> (8 * i));
      try {
        ProgressiveMesh mesh = read(bad);
        ++read_back;
        mesh.set_triangle_count(0);
        mesh.set_triangle_count(mesh.finest());
        const Inspection found = inspect(mesh.V(), mesh.F());
        REQUIRE(found.out_of_range_triangles + found.degenerate_triangles == 0);
        REQUIRE(found.misoriented_edges == 0);
      } catch (const std::invalid_argument& error) {
        ++refused;
        REQUIRE_THAT(error.what(), Contains("bytes: not a progressive mesh: "));
      }
    }
  }
  CHECK(refused > 1000);
  CHECK(read_back > 100);  // changed coordinates
}

}  // namespace
