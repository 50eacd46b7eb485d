#include "levelset_views.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace shape3d::apps {
namespace {

template <class T>
void mark(const zmc::VolumeView& view, const std::vector<double>& labels,
          std::vector<std::uint8_t>& mask) {
  const std::array<std::int64_t, 3> strides = view.effective_strides();
  const T* data = static_cast<const T*>(view.data);
  std::size_t n = 0;
  for (std::int64_t k = 0; k < view.dims[2]; ++k) {
    for (std::int64_t j = 0; j < view.dims[1]; ++j) {
      for (std::int64_t i = 0; i < view.dims[0]; ++i) {
        const auto value =
            static_cast<double>(data[i * strides[0] + j * strides[1] + k * strides[2]]);
        const bool counts = labels.empty()
                                ? value != 0.0
                                : std::find(labels.begin(), labels.end(), value) != labels.end();
        mask[n++] = counts ? 1 : 0;
      }
    }
  }
}

}  // namespace

levelset::ImageView image_of(const zmc::VolumeView& view) {
  levelset::ImageView image;
  image.data = view.data;
  image.dims = view.dims;
  image.strides = view.effective_strides();
  image.spacing = view.spacing;
  switch (view.type) {
    case zmc::SampleType::int8:
      image.type = levelset::SampleType::int8;
      break;
    case zmc::SampleType::uint8:
      image.type = levelset::SampleType::uint8;
      break;
    case zmc::SampleType::int16:
      image.type = levelset::SampleType::int16;
      break;
    case zmc::SampleType::uint16:
      image.type = levelset::SampleType::uint16;
      break;
    case zmc::SampleType::int32:
      image.type = levelset::SampleType::int32;
      break;
    case zmc::SampleType::float32:
      image.type = levelset::SampleType::float32;
      break;
    case zmc::SampleType::float64:
      image.type = levelset::SampleType::float64;
      break;
  }
  return image;
}

Mask labelled(const zmc::VolumeView& view, const std::vector<double>& labels) {
  Mask mask;
  mask.dims = view.dims;
  mask.spacing = view.spacing;
  mask.samples.resize(static_cast<std::size_t>(view.dims[0] * view.dims[1] * view.dims[2]));
  switch (view.type) {
    case zmc::SampleType::int8:
      mark<std::int8_t>(view, labels, mask.samples);
      break;
    case zmc::SampleType::uint8:
      mark<std::uint8_t>(view, labels, mask.samples);
      break;
    case zmc::SampleType::int16:
      mark<std::int16_t>(view, labels, mask.samples);
      break;
    case zmc::SampleType::uint16:
      mark<std::uint16_t>(view, labels, mask.samples);
      break;
    case zmc::SampleType::int32:
      mark<std::int32_t>(view, labels, mask.samples);
      break;
    case zmc::SampleType::float32:
      mark<float>(view, labels, mask.samples);
      break;
    case zmc::SampleType::float64:
      mark<double>(view, labels, mask.samples);
      break;
  }
  return mask;
}

}  // namespace shape3d::apps
