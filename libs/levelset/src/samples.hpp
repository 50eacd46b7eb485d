#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>

#include "message.hpp"
#include "shape3d/levelset/image_view.hpp"

namespace shape3d::levelset::detail {

/// Calls visit(T{}) with the C++ type of a sample type.
template <class Visitor>
decltype(auto) visit_sample_type(SampleType type, Visitor&& visit) {
  switch (type) {
    case SampleType::int8:
      return visit(std::int8_t{});
    case SampleType::uint8:
      return visit(std::uint8_t{});
    case SampleType::int16:
      return visit(std::int16_t{});
    case SampleType::uint16:
      return visit(std::uint16_t{});
    case SampleType::int32:
      return visit(std::int32_t{});
    case SampleType::float32:
      return visit(float{});
    case SampleType::float64:
      break;
  }
  return visit(double{});
}

/// Rows of a view, whatever its type and strides.
template <class T>
class Rows {
 public:
  explicit Rows(const ImageView& view)
      : data_(static_cast<const T*>(view.data)),
        strides_(view.effective_strides()),
        length_(view.dims[0]) {}

  /// First sample of row (j, k); the next is stride() further.
  const T* row(std::int64_t j, std::int64_t k) const {
    return data_ + j * strides_[1] + k * strides_[2];
  }
  [[nodiscard]] std::int64_t stride() const { return strides_[0]; }

  void load(std::int64_t j, std::int64_t k, float* out) const {
    const T* in = row(j, k);
    if (strides_[0] == 1) {
      for (std::int64_t i = 0; i < length_; ++i) out[i] = static_cast<float>(in[i]);
    } else {
      for (std::int64_t i = 0; i < length_; ++i) out[i] = static_cast<float>(in[i * strides_[0]]);
    }
  }

 private:
  const T* data_;
  std::array<std::int64_t, 3> strides_;
  std::int64_t length_;
};

/// Row (j, k) of a view as float.
inline void load_row(const ImageView& view, std::int64_t j, std::int64_t k, float* out) {
  visit_sample_type(view.type, [&](auto sample) { Rows<decltype(sample)>(view).load(j, k, out); });
}

[[noreturn]] inline void refuse_sample(std::int64_t i, std::int64_t j, std::int64_t k,
                                       double value) {
  refuse("image: sample " + text(std::array<std::int64_t, 3>{i, j, k}),
         std::isnan(value) ? "NaN" : text(value), "a finite number");
}

/// @throws std::invalid_argument  naming the first sample that is NaN or infinite.
void require_finite(const ImageView& view, int threads);

/// @throws std::invalid_argument  naming the field and its first value that is NaN or infinite.
void require_finite(const Field& field, const char* name);

}  // namespace shape3d::levelset::detail
