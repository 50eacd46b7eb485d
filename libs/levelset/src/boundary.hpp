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
  BoundaryDistance(const ImageView& image, const IntensityModel& model, double limit, int passes,
                   int threads);

  [[nodiscard]] const Lattice& lattice() const { return lattice_; }

  /// Computes the distance to the boundary at `levels` = model.levels(λ), or at one of its levels.
  /// Returns the tiles where it may be less than the limit, ascending; rows() has their rows. What
  /// field() has elsewhere means nothing.
  const std::vector<std::int64_t>& compute(double lambda, const std::vector<double>& levels);
  /// Signed distance, padded: negative inside.
  [[nodiscard]] const Field& field() const { return from_; }
  /// By tile: the rows that were computed.
  [[nodiscard]] const std::vector<RowMask>& rows() const { return rows_; }
  /// −1 or 1: the side on which a dense row lies that was not computed.
  [[nodiscard]] float side(std::int64_t padded_row) const;

 private:
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
  };
  std::vector<Range> ranges_;  // by tile and row: of the row and the nodes beside it
  std::vector<RowMask> rows_;
  std::vector<std::int64_t> tiles_;
  double lambda_ = 0.0;
};

}  // namespace shape3d::levelset::detail
