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
  /// Returns the tiles where it may be less than the limit, ascending; outside them field() is not
  /// set.
  const std::vector<std::int64_t>& compute(double lambda, const std::vector<double>& levels);
  /// Signed distance, padded: negative inside.
  [[nodiscard]] const Field& field() const { return from_; }
  /// −1 or 1 for a tile outside the list of compute(): the side it lies on.
  [[nodiscard]] float side(std::int64_t tile) const;

 private:
  void find_tiles(double lambda, const std::vector<double>& levels);

  Lattice lattice_;
  const IntensityModel& model_;
  float limit_;
  int passes_, threads_;
  bool single_;  // one level, at which Λ rises or falls: the field is the intensity itself
  bool rising_;
  Field intensity_;    // padded
  Field level_field_;  // with several levels: distance in intensity to the nearest, padded
  Field from_, to_;
  std::vector<float> least_, greatest_;  // of a tile and the nodes that its distances depend on
  std::vector<std::int64_t> tiles_;
  double lambda_ = 0.0;
};

}  // namespace shape3d::levelset::detail
