#include "flying_edges.hpp"

#include <algorithm>
#include <stdexcept>

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <Eigen/LU>

#include "common/vtk_samples.hpp"

namespace shape3d::apps::viewer {
vtkSmartPointer<vtkPolyData> flying_edges(const zmc::VolumeView& volume, double isovalue,
                                          zmc::Inside inside) {
  const auto& dims = volume.dims;
  if (volume.effective_strides() != std::array<std::int64_t, 3>{1, dims[0], dims[0] * dims[1]})
    throw std::invalid_argument("samples are not dense; expected x fastest without gaps");
  const auto samples =
      vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(vtk_type(volume.type)));
  samples->SetVoidArray(const_cast<void*>(volume.data), dims[0] * dims[1] * dims[2], 1);
  vtkNew<vtkImageData> image;  // lattice coordinates: VTK's filter knows no directions
  image->SetDimensions(static_cast<int>(dims[0]), static_cast<int>(dims[1]),
                       static_cast<int>(dims[2]));
  image->GetPointData()->SetScalars(samples);
  vtkNew<vtkFlyingEdges3D> filter;
  filter->SetInputData(image);
  filter->SetValue(0, isovalue);
  filter->ComputeNormalsOn();
  filter->ComputeScalarsOff();
  filter->Update();
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->ShallowCopy(filter->GetOutput());
  if (surface->GetNumberOfPoints() == 0) return surface;

  const Eigen::Matrix3d steps = volume.direction * volume.spacing.asDiagonal();
  const Eigen::Matrix3d normals_to_world = steps.inverse().transpose();
  // The filter's normals point to smaller samples.
  const double sign = inside == zmc::Inside::above ? 1.0 : -1.0;
  vtkDataArray* points = surface->GetPoints()->GetData();
  vtkDataArray* normals = surface->GetPointData()->GetNormals();
  for (vtkIdType n = 0; n < points->GetNumberOfTuples(); ++n) {
    Eigen::Vector3d p, normal;
    points->GetTuple(n, p.data());
    points->SetTuple(n, volume.world(p).eval().data());
    if (normals == nullptr) continue;
    normals->GetTuple(n, normal.data());
    normals->SetTuple(n, (sign * (normals_to_world * normal).stableNormalized()).eval().data());
  }
  surface->GetPoints()->Modified();
  return surface;
}

}  // namespace shape3d::apps::viewer
