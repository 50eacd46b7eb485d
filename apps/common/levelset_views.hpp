#pragma once

#include <vector>

#include <shape3d/levelset/image_view.hpp>
#include <shape3d/zmc/volume_view.hpp>

#include "label_map.hpp"

namespace shape3d::apps {

/// The samples of a volume as levelset sees them; its place in the world is left behind.
[[nodiscard]] levelset::ImageView image_of(const zmc::VolumeView& view);

/// A dense array in the place of a view.
template <class T>
[[nodiscard]] zmc::VolumeView in_place_of(const zmc::VolumeView& view, const T* data) {
  zmc::VolumeView result = view;
  result.data = data;
  result.type = zmc::SampleTypeOf<T>::value;
  result.strides = {0, 0, 0};
  return result;
}

/// The samples of these labels; without any: all that are not 0.
[[nodiscard]] Mask labelled(const zmc::VolumeView& view, const std::vector<double>& labels);

}  // namespace shape3d::apps
