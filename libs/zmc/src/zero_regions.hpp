#pragma once

#include <cstdint>

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

 private:
  std::int64_t words_ = 0;
  std::int64_t count_ = 0;
  bool uniform_ = true;  ///< All solved neighbours see one sign, so that no search is needed.
  int uniform_sign_ = 0;
  detail::Buffer<Word> positive_, negative_;  ///< Bit rows like the lattice's.
};

/// Sign of a cell at its face (0 … 5), seen from the cell: that of an all-zero cell is its own; 0
/// where the face is neither a zero face nor of case 11, or undefined.
int face_sign(const LatticeCells& cells, const ZeroRegions& regions, std::int64_t i, std::int64_t j,
              std::int64_t k, int face);

}  // namespace shape3d::zmc::detail
