#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "support/random_numbers.hpp"

namespace shape3d::test {

enum class NoduleKind { isolated, on_vessel, at_pleura, ground_glass };

/// A cone between two places; all lengths in samples.
struct VesselSegment {
  Eigen::Vector3d start, end;
  double start_radius, end_radius;
};

struct AnatomicNodule {
  NoduleKind kind;
  Eigen::Vector3d centre;
  double radius;
};

/// The shapes of the lung phantom, in lattice coordinates.
///
/// Lungs: two superellipsoids Σ |xᵢ/aᵢ|³ ≤ 1 that leave the volume at its first and last slice.
/// Vessels: trees from the side of each lung that faces the other. A vessel of radius r runs for
/// about 6 r and parts in two by Murray's law, r³ = r₁³ + r₂³, down to the thinnest.
class LungAnatomy {
 public:
  LungAnatomy(const std::array<std::int64_t, 3>& dims, RandomNumbers& random);

  /// Distance to the pleura, positive in a lung; to first order near it.
  [[nodiscard]] double depth_in_lung(const Eigen::Vector3d& p) const;
  [[nodiscard]] const std::vector<VesselSegment>& vessels() const { return vessels_; }
  [[nodiscard]] const std::vector<AnatomicNodule>& nodules() const { return nodules_; }

 private:
  struct Lung {
    Eigen::Vector3d centre, axes;
  };

  void place_nodules(RandomNumbers& random);
  [[nodiscard]] bool place_nodule(NoduleKind kind, double radius, double gap,
                                  RandomNumbers& random);
  void grow_trees(RandomNumbers& random);
  void grow(const Eigen::Vector3d& start, const Eigen::Vector3d& direction, double radius,
            RandomNumbers& random);
  [[nodiscard]] bool free_for_vessel(const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                                     double radius) const;

  Eigen::Vector3d dims_;
  std::array<Lung, 2> lungs_;
  std::vector<VesselSegment> vessels_;
  std::vector<AnatomicNodule> nodules_;
};

}  // namespace shape3d::test
