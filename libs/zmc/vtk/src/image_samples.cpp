#include "image_samples.hpp"

#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkSOADataArrayTemplate.h>

namespace shape3d::zmc_vtk {
namespace {

template <class T>
constexpr bool kReadByLibrary = std::is_floating_point_v<T> || sizeof(T) < 4 ||
                                (sizeof(T) == 4 && std::is_signed_v<T>);

/// The library's name of a type it reads: char and long are some integer of their size.
template <class T>
constexpr zmc::SampleType sample_type() {
  using zmc::SampleType;
  if constexpr (std::is_floating_point_v<T>) {
    return sizeof(T) == 4 ? SampleType::float32 : SampleType::float64;
  } else if constexpr (sizeof(T) == 1) {
    return std::is_signed_v<T> ? SampleType::int8 : SampleType::uint8;
  } else if constexpr (sizeof(T) == 2) {
    return std::is_signed_v<T> ? SampleType::int16 : SampleType::uint16;
  } else {
    return SampleType::int32;
  }
}

/// Integers of this size and less are doubles.
constexpr std::uint64_t kExact = std::uint64_t{1} << std::numeric_limits<double>::digits;

/// Whether a double holds an integer: its bits from the first to the last that is set are few.
template <class T>
bool exact_in_double(T value) {
  auto magnitude = static_cast<std::uint64_t>(value);
  if (value < T{0}) magnitude = ~magnitude + 1;
  while (magnitude > kExact && magnitude % 2 == 0) magnitude /= 2;
  return magnitude <= kExact;
}

[[noreturn]] void refuse(const vtkImageData& image, const std::array<std::int64_t, 3>& index,
                         const std::string& value) {
  const int* extent = const_cast<vtkImageData&>(image).GetExtent();
  std::string place;
  for (int d = 0; d < 3; ++d) {
    place += (d == 0 ? "" : ", ") + std::to_string(extent[2 * d] + index[d]);
  }
  throw std::invalid_argument("sample (" + place +
                              "): expected an integer that double can hold, got " + value);
}

/// Calls body(index in the image, point id) for the samples of a block, x fastest.
template <class Body>
void for_each_sample(const ImageSamples& samples, const Body& body) {
  const auto& dims = samples.view.dims;
  for (std::int64_t k = 0; k < dims[2]; ++k) {
    for (std::int64_t j = 0; j < dims[1]; ++j) {
      for (std::int64_t i = 0; i < dims[0]; ++i) {
        body({samples.lower[0] + i, samples.lower[1] + j, samples.lower[2] + k},
             samples.point(i, j, k));
      }
    }
  }
}

/// Points the view at samples of type T, `step` apart, or converts them.
template <class T>
void view_samples(const vtkImageData& image, const T* first, std::int64_t step,
                  ImageSamples& samples) {
  if constexpr (kReadByLibrary<T>) {
    samples.view.type = sample_type<T>();
    samples.view.data = first + step * samples.point(0, 0, 0);
    for (std::size_t d = 0; d < 3; ++d) samples.view.strides[d] = step * samples.strides[d];
  } else {
    double* out = samples.converted.data();
    for_each_sample(samples, [&](const std::array<std::int64_t, 3>& index, std::int64_t point) {
      const T value = first[step * point];
      if constexpr (sizeof(T) == 8) {
        if (!exact_in_double(value)) refuse(image, index, std::to_string(value));
      }
      *out++ = static_cast<double>(value);
    });
  }
}

/// Samples that can only be had one by one.
void convert_samples(const vtkImageData& image, vtkDataArray& array, int component,
                     ImageSamples& samples) {
  const int type = array.GetDataType();
  const bool wide = type != VTK_FLOAT && type != VTK_DOUBLE && array.GetDataTypeSize() == 8;
  double* out = samples.converted.data();
  for_each_sample(samples, [&](const std::array<std::int64_t, 3>& index, std::int64_t point) {
    const double value = array.GetComponent(point, component);
    // Rounded already, so larger ones may have been others.
    if (wide && !(value < static_cast<double>(kExact) && value > -static_cast<double>(kExact)))
      refuse(image, index, std::to_string(value));
    *out++ = value;
  });
}

/// Finds the array's memory. False: it has none of a known layout.
template <class T>
bool view_array(const vtkImageData& image, vtkDataArray& array, int component,
                ImageSamples& samples) {
  if (array.HasStandardMemoryLayout()) {
    view_samples(image, static_cast<const T*>(array.GetVoidPointer(component)),
                 array.GetNumberOfComponents(), samples);
    return true;
  }
  if (auto* soa = vtkSOADataArrayTemplate<T>::FastDownCast(&array)) {
    view_samples(image, static_cast<const T*>(soa->GetComponentArrayPointer(component)), 1,
                 samples);
    return true;
  }
  return false;
}

}  // namespace

ImageSamples image_samples(vtkImageData& image, vtkDataArray& array, int component,
                           const std::array<int, 6>& extent) {
  const std::string name = array.GetName() != nullptr ? array.GetName() : "";
  if (array.GetNumberOfTuples() != image.GetNumberOfPoints()) {
    throw std::invalid_argument("array '" + name + "': expected a tuple for each of the " +
                                std::to_string(image.GetNumberOfPoints()) + " points, got " +
                                std::to_string(array.GetNumberOfTuples()));
  }
  if (component < 0 || component >= array.GetNumberOfComponents()) {
    throw std::invalid_argument("array component: expected one of the " +
                                std::to_string(array.GetNumberOfComponents()) + " of array '" +
                                name + "', counted from 0, got " + std::to_string(component));
  }

  ImageSamples samples;
  zmc::VolumeView& view = samples.view;
  const int* whole = image.GetExtent();
  std::int64_t stride = 1;
  for (std::size_t d = 0; d < 3; ++d) {
    samples.lower[d] = std::int64_t{extent[2 * d]} - whole[2 * d];
    samples.strides[d] = stride;
    view.dims[d] = std::int64_t{extent[2 * d + 1]} - extent[2 * d] + 1;
    stride *= std::int64_t{whole[2 * d + 1]} - whole[2 * d] + 1;
  }
  image.TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], view.origin.data());
  for (int d = 0; d < 3; ++d) {
    const double spacing = image.GetSpacing()[d], sign = spacing < 0.0 ? -1.0 : 1.0;
    view.spacing[d] = sign * spacing;
    for (int row = 0; row < 3; ++row)
      view.direction(row, d) = sign * image.GetDirectionMatrix()->GetElement(row, d);
  }

  const auto make_room = [&] {
    view.type = zmc::SampleType::float64;
    view.strides = {0, 0, 0};
    samples.converted.resize(static_cast<std::size_t>(view.dims[0] * view.dims[1] * view.dims[2]));
    view.data = samples.converted.data();
  };
  bool found = false;
  switch (array.GetDataType()) {
    vtkTemplateMacro(if (!kReadByLibrary<VTK_TT>) make_room();
                     found = view_array<VTK_TT>(image, array, component, samples));
    case VTK_BIT:
      break;
    default:
      throw std::invalid_argument("array '" + name + "': expected numbers, got elements of type " +
                                  array.GetDataTypeAsString());
  }
  if (!found) {
    make_room();
    convert_samples(image, array, component, samples);
  }
  return samples;
}

}  // namespace shape3d::zmc_vtk
