// Contours a sphere and prints its size. Fails unless it is closed and of genus 0: V - F/2 = 2.
#include <cstdio>

#include <shape3d/zmc_vtk/vtkZeroCrossingMarchingCubes.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

int main() {
  vtkNew<vtkImageData> image;
  image->SetExtent(-8, 8, -8, 8, -8, 8);
  image->AllocateScalars(VTK_SHORT, 1);
  for (int z = -8; z <= 8; ++z) {
    for (int y = -8; y <= 8; ++y) {
      for (int x = -8; x <= 8; ++x)
        *static_cast<short*>(image->GetScalarPointer(x, y, z)) =
            static_cast<short>(x * x + y * y + z * z);
    }
  }
  vtkNew<vtkZeroCrossingMarchingCubes> contour;
  contour->SetInputData(image);
  contour->SetValue(0, 30.5);
  contour->Update();
  const vtkIdType vertices = contour->GetOutput()->GetNumberOfPoints();
  const vtkIdType triangles = contour->GetOutput()->GetNumberOfCells();
  std::printf("V = %lld, F = %lld\n", static_cast<long long>(vertices),
              static_cast<long long>(triangles));
  return triangles > 0 && 2 * vertices - triangles == 4 ? 0 : 1;
}
