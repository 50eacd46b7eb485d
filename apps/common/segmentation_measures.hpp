#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace shape3d::apps {

/// A set of samples of a lattice with its place: bytes, x fastest, not 0 inside.
struct MaskView {
  const std::uint8_t* data = nullptr;
  std::array<std::int64_t, 3> dims{0, 0, 0};
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();  ///< Millimetres.
};

/// How far two masks agree. Distances in millimetres.
///
/// The surface of a mask: its samples that have a neighbour outside the mask, of the six that share
/// a face; the border of the volume, where the mask is cut off, is no surface. Distances are those
/// between the centres of surface samples, exact in any spacing.
struct SegmentationMeasures {
  double dice = 1.0;  ///< 2 |A ∩ B| / (|A| + |B|); 1 when both are empty.
  /// Of the distances from each surface sample of A to the surface of B, and of those from B to A:
  /// the 95th percentile (linear between ranks), the greater of both. Empty, as the next two, when
  /// one of the masks has no surface.
  std::optional<double> hausdorff95;
  std::optional<double> hausdorff;      ///< The greatest of those distances.
  std::optional<double> mean_distance;  ///< Mean of all of them, from A and from B together.
};

/// @throws std::invalid_argument  the masks have no data, or differ in dims or spacing.
/// Cost: O(samples of the box round both masks); memory 5 bytes for each of those.
[[nodiscard]] SegmentationMeasures compare_masks(const MaskView& a, const MaskView& b);

/// The size of a mask.
struct MaskSize {
  std::int64_t samples = 0;
  double volume = 0.0;  ///< Cubic millimetres: samples times the volume of a cell.
  /// Of the ball of this volume, mm.
  double equivalent_diameter = 0.0;
  /// Greatest distance between the centres of two samples of the mask in one slice k, mm: the
  /// longest axial diameter. 0 for single samples.
  double axial_diameter = 0.0;
};

/// @throws std::invalid_argument  the mask has no data.
/// Cost: O(samples).
[[nodiscard]] MaskSize measure_mask(const MaskView& mask);

/// The p-th percentile, 0 ≤ p ≤ 100, linear between ranks: of n sorted values, x(p/100 · (n − 1)).
/// @throws std::invalid_argument  there is no value, or p is outside 0 … 100.
[[nodiscard]] double percentile(std::vector<float> values, double p);

}  // namespace shape3d::apps
