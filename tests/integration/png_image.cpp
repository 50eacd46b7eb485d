#include "png_image.hpp"

#include <cmath>
#include <stdexcept>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

namespace shape3d::test {

bool PngImage::is(int x, int y, const std::array<double, 3>& color, double tolerance) const {
  for (std::size_t c = 0; c < 3; ++c) {
    if (std::abs(at(x, y)[c] / 255.0 - color[c]) > tolerance) return false;
  }
  return true;
}

int PngImage::count(const std::array<double, 3>& color, double tolerance) const {
  int found = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) found += is(x, y, color, tolerance) ? 1 : 0;
  }
  return found;
}

PngImage decode_png(const std::string& bytes) {
  vtkNew<vtkPNGReader> reader;
  reader->SetMemoryBuffer(bytes.data());
  reader->SetMemoryBufferLength(static_cast<vtkIdType>(bytes.size()));
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  if (image->GetNumberOfScalarComponents() != 3 || image->GetScalarType() != VTK_UNSIGNED_CHAR)
    throw std::runtime_error("not an RGB picture of 8 bits a channel");
  PngImage png;
  png.width = image->GetDimensions()[0];
  png.height = image->GetDimensions()[1];
  for (int y = png.height - 1; y >= 0; --y) {
    for (int x = 0; x < png.width; ++x) {
      const auto* p = static_cast<const unsigned char*>(image->GetScalarPointer(x, y, 0));
      png.pixels.push_back({p[0], p[1], p[2]});
    }
  }
  return png;
}

}  // namespace shape3d::test
