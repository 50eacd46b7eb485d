#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "zmc_reference_cell.hpp"

/// Zero-crossing Marching Cubes of a whole volume as sets of polygons, in a form that does not
/// depend on any order of visiting. Slow and plain; the measure for the library.
namespace shape3d::test::reference {

/// Samples minus isovalue, x fastest; negative is inside. A sample that is not finite masks its
/// cells.
struct Volume {
  std::array<std::int64_t, 3> dims{};
  std::vector<double> samples;

  [[nodiscard]] std::int64_t index(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return i + dims[0] * (j + dims[1] * k);
  }
  [[nodiscard]] double& at(std::int64_t i, std::int64_t j, std::int64_t k) {
    return samples[index(i, j, k)];
  }
  [[nodiscard]] double at(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return samples[index(i, j, k)];
  }
};

/// Surface vertex: the crossing on the lattice edge between samples a < b, or with a = b that
/// sample, which is zero.
struct Vertex {
  std::int64_t a = 0, b = 0;
  friend bool operator<(const Vertex& l, const Vertex& r) {
    return l.a != r.a ? l.a < r.a : l.b < r.b;
  }
  friend bool operator==(const Vertex& l, const Vertex& r) { return l.a == r.a && l.b == r.b; }
};

/// Cyclic list of vertices, counter-clockwise seen from the positive side, the smallest first.
using Cycle = std::vector<Vertex>;
[[nodiscard]] Cycle canonical(Cycle cycle);

struct Patch {
  std::int64_t cell = 0;  ///< Number of the cell's first sample.
  Cycle cycle;
  friend bool operator<(const Patch& l, const Patch& r) {
    return l.cell != r.cell ? l.cell < r.cell : l.cycle < r.cycle;
  }
  friend bool operator==(const Patch& l, const Patch& r) {
    return l.cell == r.cell && l.cycle == r.cycle;
  }
};

struct SurfaceSet {
  std::vector<Patch> patches;     ///< Sorted.
  std::vector<Cycle> zero_faces;  ///< Quads, sorted.
  std::vector<Cycle> closing;     ///< Triangles in faces of case 11, sorted.

  /// Everything turned over: what the negated samples must give.
  [[nodiscard]] SurfaceSet reversed() const;
  friend bool operator==(const SurfaceSet& l, const SurfaceSet& r) {
    return l.patches == r.patches && l.zero_faces == r.zero_faces && l.closing == r.closing;
  }
};

struct Census {
  std::int64_t cells_with_patch = 0;
  std::array<std::int64_t, 13> faces_by_case{};  ///< Over the six faces of each such cell.
  std::int64_t all_zero_cells = 0;
  std::int64_t masked_cells = 0;
};

struct Options {
  Ties ties = Ties::neutral;
  /// Keep the faces of case 12 between cells of one sign too, other than between two cells of eight
  /// zeros.
  bool mating = false;
  /// False: all-zero cells have no sign and no zero face is inserted beside them, to show what
  /// their sign is needed for.
  bool sign_all_zero_cells = true;
};

struct Result {
  SurfaceSet surface;
  Census census;
};

/// Zero faces: every cell has a sign at each of its case-12 faces. For a cell that is not all zero
/// it is CellSolution::region_sign. An all-zero cell has one sign for all six faces: cells with a
/// solved face neighbour (in the volume, not masked, not all zero) come first and take the sign
/// that the first such neighbour, in the order -z -y -x +x +y +z, shows at the common face; then,
/// level by level, each remaining cell takes the sign of its first face neighbour of the level
/// before, in the same order. Zero regions that touch no solved cell have no sign. The quad is
/// inserted where the signs of its two cells differ, its normal from the negative to the positive
/// cell. A face with one cell (border, mask) is not inserted.
///
/// Mating: also where the signs are equal, except between two all-zero cells. The normal then
/// points along +axis between positive cells and along -axis between negative ones, so that
/// negation turns these faces over as it does all others.
///
/// Closing triangles: in a case-11 face of which one cell chose beta and the other gamma; the
/// normal points from the beta cell to the gamma cell.
[[nodiscard]] Result extract(const Volume& volume, const Options& options = {});

/// Place of a vertex in lattice units: t = |a| / (|a| + |b|) from the lower end, clamped into
/// [2^-20, 1 - 2^-20].
[[nodiscard]] std::array<double, 3> position(const Volume& volume, const Vertex& vertex);

/// Every sample with the other sign.
[[nodiscard]] Volume negated(Volume volume);

/// One layer of samples of the value all round.
[[nodiscard]] Volume padded(const Volume& volume, double value);

}  // namespace shape3d::test::reference
