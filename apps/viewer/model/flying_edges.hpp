#pragma once

#include <vtkSmartPointer.h>
#include <shape3d/zmc/options.hpp>
#include <shape3d/zmc/volume_view.hpp>

class vtkPolyData;

namespace shape3d::apps::viewer {

/// The isosurface of vtkFlyingEdges3D in the place of the volume, for comparison. Its normals point
/// from inside to outside.
/// @throws std::invalid_argument  the samples are not dense.
[[nodiscard]] vtkSmartPointer<vtkPolyData> flying_edges(const zmc::VolumeView& volume,
                                                        double isovalue, zmc::Inside inside);

}  // namespace shape3d::apps::viewer
