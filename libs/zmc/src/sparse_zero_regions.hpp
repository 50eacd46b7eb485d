#pragma once

// Signs of all-zero cells of a volume that is only seen in windows.

#include <cstdint>
#include <vector>

#include "zero_regions.hpp"

namespace shape3d::zmc::detail {

/// The rules of ZeroRegions with memory for the all-zero cells alone: 9 bytes each.
class SparseZeroRegions {
 public:
  SparseZeroRegions(std::int64_t nx, std::int64_t ny) : nx_(nx), ny_(ny) {}

  /// Adds the all-zero cells of layers [first, last) of a window whose plane 0 is plane
  /// `window_plane` of the volume; its layers first − 1 and last must be there, unless the volume
  /// ends. In ascending order of layers.
  void scan(const LatticeCells& window, std::int64_t window_plane, std::int64_t first,
            std::int64_t last);

  /// Solves all; call once, after the last scan.
  void solve();

  /// The signs of the cells of a window.
  void apply(const SignLattice& window, std::int64_t window_plane, ZeroRegions& regions) const;

  [[nodiscard]] std::int64_t cell_count() const { return static_cast<std::int64_t>(cells_.size()); }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Index of the all-zero cell with this key, or kNone.
  [[nodiscard]] std::size_t find(std::int64_t i, std::int64_t j, std::int64_t k) const;

  std::int64_t nx_, ny_;
  std::vector<std::int64_t> cells_;  ///< i + nx·(j + ny·k), ascending.
  std::vector<std::int8_t> signs_;
  SeenSigns seen_;
};

}  // namespace shape3d::zmc::detail
