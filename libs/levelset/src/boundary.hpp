#pragma once

#include <vector>

#include "padded_field.hpp"
#include "shape3d/levelset/intensity_model.hpp"

namespace shape3d::levelset::detail {

/// Distances to {Λ(I) = λ} for many λ: intensities are read once, and only the tiles near the
/// boundary are computed.
class BoundaryDistance {
 public:
  /// @param limit  Distances are cut at this, mm.
  /// @param passes  Nodes away from those beside the boundary that get a distance.
  /// @param max_samples  Only so many samples are wanted, about: bars of 32 × 32 rows, evenly
  ///                     spread; 0: all.
  BoundaryDistance(const ImageView& image, const IntensityModel& model, double limit, int passes,
                   std::int64_t max_samples, int threads);

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
  void find_rows(double lambda, const std::vector<double>& levels);

  Lattice lattice_;
  const IntensityModel& model_;
  float limit_;
  int passes_, threads_;
  bool single_;  // one level, at which Λ rises or falls: the field is the intensity itself
  bool rising_;
  Field intensity_;    // padded
  Field level_field_;  // with several levels: distance in intensity to the nearest, padded
  Field from_, to_;
  struct Range {
    float least, greatest;
    [[nodiscard]] bool holds(double level) const {
      return static_cast<double>(least) <= level && level <= static_cast<double>(greatest);
    }
  };
  struct RowRanges {
    Range low, high;
  };
  std::vector<RowRanges> ranges_;  // by tile and row: of half a row and the nodes beside it
  std::vector<char> wanted_;       // by tile
  std::vector<RowMask> allowed_;   // by tile: rows that have a say in the wanted ones
  std::vector<HalfRows> crossed_;  // by tile: halves of rows with a node beside the boundary
  std::vector<std::vector<RowMask>> rows_;  // by passes and tile: the rows that many nodes away
  std::vector<std::int64_t> tiles_;
  double lambda_ = 0.0;
};

}  // namespace shape3d::levelset::detail
