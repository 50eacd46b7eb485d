// Prints what ITK reads of a volume file as JSON: origin, spacing, direction by rows, samples.
#include <cstdio>
#include <exception>

#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkImageRegionConstIterator.h>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  using Image = itk::Image<float, 3>;
  try {
    const Image::Pointer image = itk::ReadImage<Image>(argv[1]);
    std::printf("{\"origin\": [%.17g, %.17g, %.17g],\n", image->GetOrigin()[0],
                image->GetOrigin()[1], image->GetOrigin()[2]);
    std::printf("\"spacing\": [%.17g, %.17g, %.17g],\n\"direction\": [", image->GetSpacing()[0],
                image->GetSpacing()[1], image->GetSpacing()[2]);
    for (unsigned row = 0; row < 3; ++row) {
      std::printf("%s[%.17g, %.17g, %.17g]", row > 0 ? ", " : "", image->GetDirection()(row, 0),
                  image->GetDirection()(row, 1), image->GetDirection()(row, 2));
    }
    std::printf("],\n\"samples\": [");
    itk::ImageRegionConstIterator<Image> at(image, image->GetLargestPossibleRegion());
    for (bool first = true; !at.IsAtEnd(); ++at, first = false)
      std::printf("%s%.9g", first ? "" : ", ", static_cast<double>(at.Get()));
    std::printf("]}\n");
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
