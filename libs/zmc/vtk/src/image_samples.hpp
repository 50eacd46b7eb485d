#pragma once

// The samples of an image as the library sees them.

#include <array>
#include <cstdint>

#include "shape3d/zmc/surface.hpp"
#include "shape3d/zmc/volume_view.hpp"

class vtkDataArray;
class vtkImageData;

namespace shape3d::zmc_vtk {

/// A block of an image.
struct ImageSamples {
  zmc::VolumeView view;                   ///< Of the array itself, or of `converted`.
  zmc::detail::Buffer<double> converted;  ///< Empty when the library reads the array's type.
  std::array<std::int64_t, 3> lower{};    ///< First sample of the block, as steps into the image.
  std::array<std::int64_t, 3> strides{};  ///< Points of the image between neighbouring samples.

  /// Id in the image of sample (i, j, k) of the block.
  [[nodiscard]] std::int64_t point(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return (lower[0] + i) * strides[0] + (lower[1] + j) * strides[1] + (lower[2] + k) * strides[2];
  }
};

/// One component of point data of an image, in the extent given, which lies in that of the image.
/// The result refers to the array and must not outlive it.
/// @throws std::invalid_argument  a value cannot be held by double; the array has not the
///         component, or not a tuple for each point, or its type is not of numbers.
[[nodiscard]] ImageSamples image_samples(vtkImageData& image, vtkDataArray& array, int component,
                                         const std::array<int, 6>& extent);

}  // namespace shape3d::zmc_vtk
