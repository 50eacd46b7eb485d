#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "lattice_cells.hpp"
#include "sign_lattice.hpp"

namespace shape3d::zmc::detail {

/// Signs of the cells whose eight samples are zero.
///
/// The dissertation leaves them open ("shift until the zero face can be solved"). Here each takes a
/// sign by breadth-first search from the zero faces of the cells around: a cell with solved
/// neighbours takes the sign that the first of them, in the order −z −y −x +x +y +z, sees at the
/// shared face; a cell at distance n + 1 that of the first neighbour at distance n in the same
/// order. No step looks at which sign it is, so negated samples give negated signs. A region
/// without solved neighbours has none.
class ZeroRegions {
 public:
  /// Finds and solves all of them; call once the lattice is filled.
  void solve(const LatticeCells& cells);

  /// Sign of an all-zero cell: −1, +1, or 0 where the region has none.
  [[nodiscard]] int sign(std::int64_t i, std::int64_t row) const {
    if (uniform_) return uniform_sign_;
    const auto word = static_cast<std::size_t>(row * words_ + (i >> 6));
    if (((positive_[word] >> (i & 63)) & 1u) != 0) return 1;
    return ((negative_[word] >> (i & 63)) & 1u) != 0 ? -1 : 0;
  }
  [[nodiscard]] std::int64_t cell_count() const { return count_; }

  /// Takes over one sign for all, or room for signs of single cells, all 0 at first. `count`: of
  /// all-zero cells.
  void set_uniform(int sign, std::int64_t count);
  void set_single(const SignLattice& lattice, std::int64_t count);
  /// After set_single().
  void set_sign(std::int64_t i, std::int64_t row, int sign) {
    const auto word = static_cast<std::size_t>(row * words_ + (i >> 6));
    (sign > 0 ? positive_ : negative_)[word] |= Word{1} << (i & 63);
  }

 private:
  std::int64_t words_ = 0;
  std::int64_t count_ = 0;
  bool uniform_ = true;  ///< All solved neighbours see one sign, so that no search is needed.
  int uniform_sign_ = 0;
  detail::Buffer<Word> positive_, negative_;  ///< Bit rows like the lattice's.
};

/// A cell by its lowest corner.
struct CellPlace {
  std::int64_t i = 0, j = 0, k = 0;
};

/// Face neighbours in lattice order, and the face by which the neighbour touches the cell.
struct NeighbourStep {
  int di, dj, dk, face_of_neighbour;
};
inline constexpr std::array<NeighbourStep, 6> kNeighbourSteps{
    {{0, 0, -1, 5}, {0, -1, 0, 3}, {-1, 0, 0, 1}, {1, 0, 0, 0}, {0, 1, 0, 2}, {0, 0, 1, 4}}};

/// The all-zero cells of layers [first, last) in lattice order.
void for_each_all_zero_cell(const SignLattice& lattice, std::int64_t first, std::int64_t last,
                            const std::function<void(const CellPlace&)>& visit);

/// What the solved neighbours of all-zero cells see at the faces that they share.
struct SeenSigns {
  bool positive = false, negative = false;
};

/// The sign that the first solved neighbour of an all-zero cell sees, or 0; adds all that are seen
/// to `seen`.
int sign_of_solved_neighbour(const LatticeCells& cells, const CellPlace& cell, SeenSigns& seen);

/// Sign of a cell at its face (0 … 5), seen from the cell: that of an all-zero cell is its own; 0
/// where the face is neither a zero face nor of case 11, or undefined.
int face_sign(const LatticeCells& cells, const ZeroRegions& regions, std::int64_t i, std::int64_t j,
              std::int64_t k, int face);

}  // namespace shape3d::zmc::detail
