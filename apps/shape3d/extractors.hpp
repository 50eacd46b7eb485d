#pragma once

#include <string>
#include <vector>

#include <shape3d/zmc/options.hpp>
#include <shape3d/zmc/volume_view.hpp>

#include "common/mesh.hpp"

namespace shape3d::apps {

/// What extractors other than this library's are given and return: in lattice units times spacing,
/// origin and direction left out.
struct ExtractedMesh {
  Mesh mesh;
  double seconds = 0.0;  ///< Of the extraction alone.
};

/// Samples of a volume in a type that holds their negatives too.
class NegatableVolume {
 public:
  explicit NegatableVolume(const zmc::VolumeView& view);
  [[nodiscard]] const zmc::VolumeView& view() const { return view_; }
  /// Replaces each sample by its negative; the second call restores them.
  void negate();

 private:
  std::vector<std::int16_t> shorts_;
  std::vector<std::int32_t> integers_;
  std::vector<float> floats_;
  std::vector<double> doubles_;
  zmc::VolumeView view_;
};

enum class Extractor { zmc, vtk_flying_edges, vtk_marching_cubes };
inline constexpr Extractor kExtractors[] = {Extractor::zmc, Extractor::vtk_flying_edges,
                                            Extractor::vtk_marching_cubes};
[[nodiscard]] std::string to_string(Extractor extractor);

/// @throws std::invalid_argument  as zmc::extract().
[[nodiscard]] ExtractedMesh run_extractor(Extractor extractor, const zmc::VolumeView& view,
                                          double isovalue, const zmc::Options& options);

/// Vertices at equal positions become one; returns how many there were too many.
std::int64_t merge_coincident(Mesh& mesh);

/// How many triangles, orientation and degenerate ones aside, are in one mesh and not in the other.
[[nodiscard]] std::int64_t triangles_in_one_only(const Mesh& a, const Mesh& b);

}  // namespace shape3d::apps
