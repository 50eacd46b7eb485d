#pragma once

#include <algorithm>
#include <vector>

#include "padded_field.hpp"
#include "shape3d/levelset/intensity_model.hpp"

namespace shape3d::levelset::detail {

/// Least and greatest intensity.
struct Range {
  float least, greatest;
  [[nodiscard]] bool holds(double level) const {
    return static_cast<double>(least) <= level && level <= static_cast<double>(greatest);
  }
};
/// Of the halves of a row.
struct RowRanges {
  Range low, high;
};

/// Distances to {Λ(I) = λ} for one or many λ: intensities are read once, and only the rows near the
/// boundary are computed.
class BoundaryDistance {
 public:
  /// How often compute() is called: for many times, what each row can meet is noted first.
  enum class Use { once, many };

  /// @param limit  Distances are cut at this, mm.
  /// @param passes  Nodes away from those beside the boundary that get a distance.
  /// @param max_samples  Only so many samples are wanted, about: bars of 32 × 32 rows, evenly
  ///                     spread; 0: all.
  BoundaryDistance(const ImageView& image, const IntensityModel& model, double limit, int passes,
                   std::int64_t max_samples, Use use, int threads);

  [[nodiscard]] const Lattice& lattice() const { return lattice_; }

  /// Computes the distance to the boundary at `levels` = model.levels(λ), or at one of its levels.
  /// Returns the tiles where it may be less than the limit, ascending; rows() has their rows. What
  /// field() has elsewhere means nothing.
  const std::vector<std::int64_t>& compute(double lambda, const std::vector<double>& levels);
  /// Signed distance, padded: negative inside.
  [[nodiscard]] const Field& field() const { return from_; }
  /// The rows of a tile that were computed.
  [[nodiscard]] RowMask rows(std::int64_t tile) const { return rows_.back()[tile]; }
  /// Whether the samples of a tile are wanted.
  [[nodiscard]] bool wanted(std::int64_t tile) const { return wanted_[tile] != 0; }
  /// −1 or 1: the side on which a dense row lies that was not computed.
  [[nodiscard]] float side(std::int64_t padded_row) const;

 private:
  void choose_tiles(std::int64_t max_samples);
  /// Rows of a tile that still have a say in wanted ones before the last n passes.
  [[nodiscard]] RowMask allowed(std::int64_t tile, int n) const {
    return within_[static_cast<std::size_t>(std::min(n, kMostWithin))][tile];
  }
  void note_ranges();
  void find_crossed(const std::vector<double>& levels);
  void find_rows();

  static constexpr int kMostWithin = 8;

  Lattice lattice_;
  const IntensityModel& model_;
  float limit_;
  int passes_, threads_;
  Use use_;
  bool single_;  // one level, at which Λ rises or falls: the field is the intensity itself
  bool rising_;
  Field intensity_;    // padded
  Field level_field_;  // with several levels: distance in intensity to the nearest, padded
  Field from_, to_;
  // By tile and row: of half a row and the nodes beside it. Empty for Use::once.
  std::vector<RowRanges> ranges_;
  std::vector<char> wanted_;  // by tile
  /// By n and tile: rows up to n from wanted ones; a distance spreads by one a pass.
  std::vector<std::vector<RowMask>> within_;
  std::vector<HalfRows> crossed_;  // by tile: halves of rows with a node beside the boundary
  std::vector<std::vector<RowMask>> rows_;  // by passes and tile: the rows that many nodes away
  std::vector<std::int64_t> tiles_;
  double lambda_ = 0.0;
};

/// Y of (3.7) at all samples, 0 beyond 2 ℓ, where it is under 0.02, for k_P: fuzzy_factor() takes
/// 0.98 for 1.
Field boundary_bells(const ImageView& image, const IntensityModel& model, double lambda,
                     double width, int threads);

}  // namespace shape3d::levelset::detail
