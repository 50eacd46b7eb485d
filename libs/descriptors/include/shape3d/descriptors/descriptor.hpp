#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "shape3d/descriptors/export.hpp"
#include "shape3d/descriptors/parameters.hpp"
#include "shape3d/descriptors/surface.hpp"
#include "shape3d/descriptors/voxels.hpp"

namespace shape3d::descriptors {

/// What a feature vector is made by: a kind and its parameters, as one line of text that is stored
/// with every vector.
///
/// SPEC = kind [":" key "=" value { "," key "=" value }], for example
/// "hsh:map=equal_volume,K=8,voxels=64,fill=gedt". Keys that are left out have their defaults.
/// Kinds: hsh, csm, d2, egi, random, panorama, sni, sci, sgi; docs/notes/descriptors.md lists their
/// keys.
///
/// Holds what compute() needs and what does not depend on a mesh, so that it serves many; copies
/// share it. compute() may be called concurrently.
class SHAPE3D_DESCRIPTORS_EXPORT Descriptor {
 public:
  /// @throws std::invalid_argument  the parameters are out of range, as the parts they are for say.
  explicit Descriptor(const Parameters& parameters, Align align = Align::none);

  /// @throws std::invalid_argument  the kind or a key is unknown or a key occurs twice (the message
  /// lists those there are), a value is not one of its kind, or out of range.
  [[nodiscard]] static Descriptor parse(std::string_view spec);

  /// The canonical text: every parameter, in fixed order, numbers by the shortest decimals that
  /// read back the same. parse(to_string()) gives an equal descriptor.
  [[nodiscard]] std::string to_string() const;

  /// Empty when vectors of both can be compared; else a sentence with the first difference:
  /// "K is 8 in one and 15 in the other".
  [[nodiscard]] std::optional<std::string> difference(const Descriptor& other) const;

  [[nodiscard]] std::string_view kind() const;  ///< "hsh", "csm" …
  [[nodiscard]] const Parameters& parameters() const;
  [[nodiscard]] Align align() const;
  [[nodiscard]] Eigen::Index length() const;  ///< Numbers of a vector.
  [[nodiscard]] bool needs_map() const;       ///< Whether compute() needs S.

  /// The feature vector of a mesh, length() numbers; `align` is not applied here.
  /// @param threads  0: all processors. The result is the same, bit for bit, for any number.
  /// @throws std::invalid_argument  the mesh is refused (surface_frame()); needs_map().
  [[nodiscard]] Eigen::VectorXd compute(const Eigen::Ref<const Points>& V,
                                        const Eigen::Ref<const Triangles>& F,
                                        int threads = 0) const;

  /// What the mesh is voxelized by; null for descriptors that are not of voxels.
  [[nodiscard]] const VoxelizeOptions* voxels() const;

  /// The vector from voxels made by *voxels(): several descriptors can share them.
  /// @throws std::invalid_argument  voxels() is null; their side is another.
  [[nodiscard]] Eigen::VectorXd compute(const Voxels& voxels, int threads = 0) const;

  /// The same with a spherical map, for every kind; those of solid space do not look at it.
  /// @param S  #V by 3 unit vectors: the image of each vertex on the sphere.
  /// @throws std::invalid_argument  also when S is not a spherical map of the mesh.
  [[nodiscard]] Eigen::VectorXd compute(const Eigen::Ref<const Points>& V,
                                        const Eigen::Ref<const Triangles>& F,
                                        const Eigen::Ref<const Points>& S, int threads = 0) const;

 private:
  struct State;
  std::shared_ptr<const State> state_;
};

}  // namespace shape3d::descriptors
