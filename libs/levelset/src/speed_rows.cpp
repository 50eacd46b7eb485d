#include "speed_rows.hpp"

#include <algorithm>

#include "isa.hpp"
#include "shape3d/levelset/speed.hpp"

namespace shape3d::levelset {
namespace {

SHAPE3D_LEVELSET_INLINE float fuzzy(float gradient_factor, float boundary_factor) {
  const auto high = [](float k) { return k * k * (3.0F - 2.0F * k); };
  const float gradient_high = high(gradient_factor), boundary_high = high(boundary_factor);
  const float gradient_low = 1.0F - gradient_high, boundary_low = 1.0F - boundary_high;
  const float none = std::min(gradient_low, boundary_low);
  const float one = std::min(gradient_low, boundary_high) + std::min(gradient_high, boundary_low);
  const float both = std::min(gradient_high, boundary_high);
  return (0.5F * one + both) / (none + one + both);
}

SHAPE3D_LEVELSET_INLINE void squares(const float* __restrict gradient, std::int64_t count,
                                     float inverse_scale, float* __restrict out) {
  for (std::int64_t i = 0; i < count; ++i) {
    const float x = gradient[i] * inverse_scale;
    out[i] = 1.0F / (1.0F + x * x);
  }
}

SHAPE3D_LEVELSET_INLINE void combine(const float* __restrict bells, std::int64_t count, float least,
                                     float* __restrict factors) {
  if (bells == nullptr) {
    for (std::int64_t i = 0; i < count; ++i) factors[i] = std::max(factors[i], least);
    return;
  }
  for (std::int64_t i = 0; i < count; ++i)
    factors[i] = std::max(fuzzy(factors[i], 1.0F - bells[i]), least);
}

#if SHAPE3D_LEVELSET_X86
SHAPE3D_LEVELSET_TARGET_AVX2 void squares_avx2(const float* gradient, std::int64_t count,
                                               float inverse_scale, float* out) {
  squares(gradient, count, inverse_scale, out);
}
SHAPE3D_LEVELSET_TARGET_AVX2 void combine_avx2(const float* bells, std::int64_t count, float least,
                                               float* factors) {
  combine(bells, count, least, factors);
}
#endif
void squares_portable(const float* gradient, std::int64_t count, float inverse_scale, float* out) {
  squares(gradient, count, inverse_scale, out);
}
void combine_portable(const float* bells, std::int64_t count, float least, float* factors) {
  combine(bells, count, least, factors);
}

}  // namespace

float fuzzy_factor(float gradient_factor, float boundary_factor) {
  return fuzzy(gradient_factor, boundary_factor);
}

namespace detail {

void square_factors(const float* gradient, std::int64_t count, float inverse_scale, float* out) {
  SHAPE3D_LEVELSET_DISPATCH(squares, gradient, count, inverse_scale, out);
}

void fuzzy_factors(const float* bells, std::int64_t count, float least, float* factors) {
  SHAPE3D_LEVELSET_DISPATCH(combine, bells, count, least, factors);
}

}  // namespace detail
}  // namespace shape3d::levelset
