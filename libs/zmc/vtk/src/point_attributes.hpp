#pragma once

// Point data of the image at the vertices of a surface.

#include <cstdint>
#include <vector>

#include "image_samples.hpp"

class vtkDataArray;
class vtkPointData;

namespace shape3d::zmc_vtk {

/// Where vertices get their values from.
struct VertexSources {
  /// Ids of image points of the ends of a vertex' lattice edge. For centroids lower is −1 − c,
  /// where c counts centroids.
  std::vector<std::int64_t> lower, upper;
  std::vector<double> parameters;  ///< Place between the ends, 0 … 1.
  /// The vertices that centroid c is the mean of: members[first[c]] … members[first[c + 1] − 1].
  std::vector<std::int64_t> first, members;
};

template <class Real, class Index>
[[nodiscard]] VertexSources vertex_sources(const zmc::Surface<Real, Index>& surface,
                                           const ImageSamples& samples);

/// Adds the arrays of `from` but `skipped`, ids and ghost flags, interpolated.
void interpolate_attributes(vtkPointData& from, const vtkDataArray* skipped,
                            const VertexSources& sources, vtkPointData& to);

}  // namespace shape3d::zmc_vtk
