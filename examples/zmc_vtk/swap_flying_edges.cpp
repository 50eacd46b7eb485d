// An ordinary VTK program: two touching boxes of a label image become a surface, which further
// filters measure. The type in one line of measure() is all that the two contour filters differ in.
//
// Prints triangles, triangles without area, and edges that are on a border. Both boxes are closed
// bodies inside the image, so the surface should have neither.

#include <cstdio>

#include <shape3d/zmc_vtk/vtkZeroCrossingMarchingCubes.h>
#include <vtkFeatureEdges.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkTriangle.h>

namespace {

/// −1 in the background, 1 in the boxes, and 0 where a label is not sure.
void fill(vtkImageData* image) {
  image->SetDimensions(40, 40, 40);
  image->AllocateScalars(VTK_SIGNED_CHAR, 1);
  const auto within = [](int x, int low, int high) { return x >= low && x <= high; };
  for (int z = 0; z < 40; ++z) {
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 40; ++x) {
        const bool first = within(x, 5, 20) && within(y, 5, 20) && within(z, 5, 30);
        const bool second = within(x, 21, 34) && within(y, 21, 34) && within(z, 5, 30);
        const bool unsure = within(y, 12, 28) && within(z, 18, 20);
        *static_cast<signed char*>(image->GetScalarPointer(x, y, z)) =
            first || second ? static_cast<signed char>(unsure ? 0 : 1)
                            : static_cast<signed char>(-1);
      }
    }
  }
}

template <class ContourFilter>
void measure(const char* name, vtkImageData* image) {
  vtkNew<ContourFilter> contour;  // vtkNew<vtkFlyingEdges3D> in the program as it was
  contour->SetInputData(image);
  contour->SetValue(0, 0.0);

  vtkNew<vtkFeatureEdges> borders;
  borders->SetInputConnection(contour->GetOutputPort());
  borders->FeatureEdgesOff();
  borders->NonManifoldEdgesOff();
  borders->Update();

  vtkPolyData* surface = contour->GetOutput();
  int flat = 0;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell) {
    auto* triangle = vtkTriangle::SafeDownCast(surface->GetCell(cell));
    if (triangle->ComputeArea() == 0.0) ++flat;
  }
  std::printf("%-15s %10lld %12d %14lld\n", name,
              static_cast<long long>(surface->GetNumberOfCells()), flat,
              static_cast<long long>(borders->GetOutput()->GetNumberOfLines()));
}

}  // namespace

int main() {
  vtkNew<vtkImageData> image;
  fill(image);
  std::printf("%-15s %10s %12s %14s\n", "", "triangles", "without area", "border edges");
  measure<vtkFlyingEdges3D>("flying edges", image);
  measure<vtkZeroCrossingMarchingCubes>("zero-crossing", image);
}
