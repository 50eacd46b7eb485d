#pragma once

// Images that tests contour, and what they look at in outputs.

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <vtkCommand.h>
#include <vtkImageAlgorithm.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "shape3d/zmc/extract.hpp"
#include "shape3d/zmc_vtk/vtkZeroCrossingMarchingCubes.h"

namespace shape3d::zmc_vtk::test {

using Extent = std::array<int, 6>;
/// Of the indices in the extent.
using Field = std::function<double(int, int, int)>;

/// An image with scalars "samples" of a VTK type.
[[nodiscard]] vtkSmartPointer<vtkImageData> make_image(const Extent& extent, int type,
                                                       const Field& field);

/// Produces the part of an image that it is asked for: scalars "samples" of short from a field of
/// integers, and the points' coordinates as the array "coordinates" of double.
class PartSource : public vtkImageAlgorithm {
 public:
  static PartSource* New();
  void Produce(const Extent& whole, const Field& field);

 protected:
  PartSource() { this->SetNumberOfInputPorts(0); }
  int RequestInformation(vtkInformation* request, vtkInformationVector** in,
                         vtkInformationVector* out) override;
  int RequestData(vtkInformation* request, vtkInformationVector** in,
                  vtkInformationVector* out) override;

 private:
  Extent whole_{};
  Field field_;
};

/// Adds the coordinates of points as an array of three components.
template <class Array>
void add_coordinates(vtkImageData* image, const char* name) {
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(image->GetNumberOfPoints());
  for (vtkIdType id = 0; id < image->GetNumberOfPoints(); ++id)
    array->SetTuple(id, image->GetPoint(id));
  image->GetPointData()->AddArray(array);
}

/// 100 times the distance from (i, j, k) = centre.
[[nodiscard]] inline Field distance_from(double x, double y, double z) {
  return [=](int i, int j, int k) {
    return 100.0 * std::sqrt((i - x) * (i - x) + (j - y) * (j - y) + (k - z) * (k - z));
  };
}

[[nodiscard]] inline Eigen::Vector3d point(vtkPolyData* mesh, vtkIdType id) {
  return Eigen::Vector3d(mesh->GetPoint(id));
}
[[nodiscard]] std::array<vtkIdType, 3> triangle(vtkPolyData* mesh, vtkIdType cell);

/// Twice the area, along the normal.
[[nodiscard]] Eigen::Vector3d area_vector(vtkPolyData* mesh, vtkIdType cell);

/// Six times the volume is the sum over triangles of det(a, b, c): positive when they point out.
[[nodiscard]] double signed_volume(vtkPolyData* mesh);

/// Edges of an odd number of triangles.
[[nodiscard]] int odd_edges(vtkPolyData* mesh);

/// Whether points and triangles are those of a surface of the library, bit for bit.
template <class Real, class Index>
[[nodiscard]] bool equals(vtkPolyData* mesh, const zmc::Surface<Real, Index>& surface) {
  if (mesh->GetNumberOfPoints() != surface.vertex_count() ||
      mesh->GetNumberOfCells() != surface.triangle_count())
    return false;
  for (vtkIdType v = 0; v < mesh->GetNumberOfPoints(); ++v) {
    for (int d = 0; d < 3; ++d) {
      if (mesh->GetPoint(v)[d] != static_cast<double>(surface.V()(v, d))) return false;
    }
  }
  for (vtkIdType t = 0; t < mesh->GetNumberOfCells(); ++t) {
    const auto corners = triangle(mesh, t);
    for (int n = 0; n < 3; ++n) {
      if (corners[n] != surface.F()(t, n)) return false;
    }
  }
  return true;
}

/// Text of the errors of a filter and its executive, kept from the screen.
class ErrorLog {
 public:
  explicit ErrorLog(vtkAlgorithm* filter);
  ~ErrorLog();
  ErrorLog(const ErrorLog&) = delete;
  void operator=(const ErrorLog&) = delete;

  /// Of the filter itself.
  [[nodiscard]] const std::vector<std::string>& errors() const { return errors_; }

 private:
  vtkAlgorithm* filter_;
  std::vector<std::string> errors_;
  unsigned long tag_ = 0, executive_tag_ = 0;
};

}  // namespace shape3d::zmc_vtk::test
