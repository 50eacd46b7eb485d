#include "zero_faces.hpp"

#include <algorithm>

namespace shape3d::zmc::detail {
namespace {

/// Negative, zero and positive bits of one corner of 64 faces.
struct CornerWords {
  Word n = 0, z = 0, p = 0;
};

CornerWords corner_words(const SignLattice& lattice, std::int64_t row, std::int64_t w, bool next) {
  CornerWords c;
  const Word n = next ? load_next(lattice.n_row(row), w) : load(lattice.n_row(row) + w);
  c.z = next ? load_next(lattice.z_row(row), w) : load(lattice.z_row(row) + w);
  c.n = n & ~c.z;
  c.p = ~(n | c.z);
  return c;
}

Word opposite(const CornerWords& a, const CornerWords& b) { return (a.n & b.p) | (a.p & b.n); }

/// Faces of case 12 and of case 11, from their corners in cyclic order.
struct FaceWords {
  Word zero = 0, mixed = 0;
};
FaceWords face_words(const CornerWords& a, const CornerWords& b, const CornerWords& c,
                     const CornerWords& d) {
  FaceWords f;
  f.zero = a.z & b.z & c.z & d.z;
  f.mixed = (a.z & b.z & opposite(c, d)) | (b.z & c.z & opposite(d, a)) |
            (c.z & d.z & opposite(a, b)) | (d.z & a.z & opposite(b, c));
  return f;
}

bool all_zero(const SignLattice& lattice, std::int64_t i, std::int64_t j, std::int64_t k) {
  return (lattice.cell_mask(i, j, k) & 0xFF00u) == 0xFF00u;
}

}  // namespace

std::optional<InsertedFace> inserted_face(const LatticeCells& cells, const ZeroRegions& regions,
                                          ZeroFaces rule, std::int64_t i, std::int64_t j,
                                          std::int64_t k, int axis, bool closing) {
  const SignLattice& lattice = cells.lattice();
  const std::int64_t li = i - (axis == 0), lj = j - (axis == 1), lk = k - (axis == 2);
  if (!lattice.cell_valid(i, j, k) || !lattice.cell_valid(li, lj, lk)) return std::nullopt;
  const int upper = face_sign(cells, regions, i, j, k, lower_face(axis));
  const int lower = face_sign(cells, regions, li, lj, lk, lower_face(axis) + 1);
  InsertedFace face{i, static_cast<std::int32_t>(j), static_cast<std::int8_t>(axis), closing,
                    upper > lower};
  if (upper * lower < 0) return face;
  if (rule == ZeroFaces::boundary || closing) return std::nullopt;
  if (all_zero(lattice, i, j, k) && all_zero(lattice, li, lj, lk)) return std::nullopt;
  face.towards_upper = upper + lower >= 0;
  return face;
}

void find_inserted_faces(const LatticeCells& cells, const ZeroRegions& regions, ZeroFaces rule,
                         std::int64_t k, std::vector<InsertedFace>& quads,
                         std::vector<InsertedFace>& closing) {
  const SignLattice& lattice = cells.lattice();
  if (k + 1 >= lattice.nz) return;

  const auto examine = [&](std::int64_t i, std::int64_t j, int axis, bool mixed) {
    const auto face = inserted_face(cells, regions, rule, i, j, k, axis, mixed);
    if (face) (mixed ? closing : quads).push_back(*face);
  };

  for (std::int64_t j = 0; j + 1 < lattice.ny; ++j) {
    const std::int64_t r[4] = {lattice.row(j, k), lattice.row(j + 1, k), lattice.row(j, k + 1),
                               lattice.row(j + 1, k + 1)};
    unsigned zeros = 0;
    for (const std::int64_t row : r) zeros |= lattice.flags[static_cast<std::size_t>(row)];
    if ((zeros & kRowZero) == 0) continue;
    for (std::int64_t w = 0; w < lattice.words; ++w) {
      const Word any = load(lattice.z_row(r[0]) + w) | load(lattice.z_row(r[1]) + w) |
                       load(lattice.z_row(r[2]) + w) | load(lattice.z_row(r[3]) + w);
      const Word after = load(lattice.z_row(r[0]) + w + 1) | load(lattice.z_row(r[1]) + w + 1) |
                         load(lattice.z_row(r[2]) + w + 1) | load(lattice.z_row(r[3]) + w + 1);
      if ((any | (after & 1u)) == 0) continue;
      // Both kinds of face have a zero edge; most words with zeros have none.
      std::array<Word, 4> z{}, z_next{};
      for (int n = 0; n < 4; ++n) {
        z[n] = load(lattice.z_row(r[n]) + w);
        z_next[n] = load_next(lattice.z_row(r[n]), w);
      }
      Word zero_edge =
          ((z[0] | z_next[1]) & (z[1] | z_next[0])) | ((z[0] | z_next[2]) & (z[2] | z_next[0]));
      zero_edge |= (z[2] & (z_next[2] | z[3])) | (z[1] & (z_next[1] | z[3]));
      if (zero_edge == 0) continue;
      std::array<std::array<CornerWords, 2>, 4> c;
      for (int n = 0; n < 4; ++n)
        c[n] = {corner_words(lattice, r[n], w, false), corner_words(lattice, r[n], w, true)};
      const Word in_cells = below_mask(lattice.nx - 1, w);
      const Word not_first = w == 0 ? in_cells & ~Word{1} : in_cells;
      std::array<FaceWords, 3> f{};
      f[0] = face_words(c[0][0], c[1][0], c[3][0], c[2][0]);
      f[0].zero &= not_first, f[0].mixed &= not_first;
      if (j > 0) {
        f[1] = face_words(c[0][0], c[0][1], c[2][1], c[2][0]);
        f[1].zero &= in_cells, f[1].mixed &= in_cells;
      }
      if (k > 0) {
        f[2] = face_words(c[0][0], c[0][1], c[1][1], c[1][0]);
        f[2].zero &= in_cells, f[2].mixed &= in_cells;
      }
      Word cells_with_face = 0;
      for (const FaceWords& face : f) cells_with_face |= face.zero | face.mixed;
      for (; cells_with_face != 0; cells_with_face &= cells_with_face - 1) {
        const int bit = __builtin_ctzll(cells_with_face);
        for (int axis = 0; axis < 3; ++axis) {
          if (((f[axis].zero >> bit) & 1u) != 0) examine(64 * w + bit, j, axis, false);
          if (((f[axis].mixed >> bit) & 1u) != 0) examine(64 * w + bit, j, axis, true);
        }
      }
    }
  }
}

FacePolygon face_polygon(const SignLattice& lattice, const InsertedFace& face, std::int64_t k) {
  // kCellFaces run counter-clockwise seen from below the face (the outside of the cell above it).
  const auto& corners = kCellFaces[lower_face(face.axis)];
  FacePolygon polygon;
  if (!face.closing) {
    polygon.size = 4;
    for (int n = 0; n < 4; ++n) polygon.vertices[n] = 12 + corners[n];
  } else {
    std::array<bool, 4> zero{};
    for (int n = 0; n < 4; ++n) {
      const auto& p = kCellVertices[corners[n]];
      zero[n] = lattice.is_zero(face.i + p[0], lattice.row(face.j + p[1], k + p[2]));
    }
    int q = 0;
    while (!zero[q] || !zero[(q + 1) % 4]) ++q;
    const int a = corners[(q + 2) % 4], b = corners[(q + 3) % 4];
    int crossing = 0;
    while (!((kCellEdges[crossing][0] == a && kCellEdges[crossing][1] == b) ||
             (kCellEdges[crossing][0] == b && kCellEdges[crossing][1] == a))) {
      ++crossing;
    }
    polygon.size = 3;
    polygon.vertices = {12 + corners[q], 12 + corners[(q + 1) % 4], crossing, 0};
  }
  if (face.towards_upper)
    std::reverse(polygon.vertices.begin() + 1, polygon.vertices.begin() + polygon.size);
  return polygon;
}

}  // namespace shape3d::zmc::detail
