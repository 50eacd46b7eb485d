#include "filter_rows.hpp"

#include <algorithm>
#include <cmath>

#include "isa.hpp"

namespace shape3d::levelset::detail {
namespace {

SHAPE3D_LEVELSET_INLINE void add_two(const float* __restrict in, std::int64_t count, float wa,
                                     float* __restrict a, float wb, float* __restrict b) {
  for (std::int64_t i = 0; i < count; ++i) {
    a[i] += wa * in[i];
    b[i] += wb * in[i];
  }
}

SHAPE3D_LEVELSET_INLINE void add_one(const float* __restrict in, std::int64_t count, float w,
                                     float* __restrict out) {
  for (std::int64_t i = 0; i < count; ++i) out[i] += w * in[i];
}

SHAPE3D_LEVELSET_INLINE void row_kernel(const float* __restrict in, std::int64_t count,
                                        const float* kernel, int radius, float* __restrict out) {
  for (std::int64_t i = 0; i < count; ++i) out[i] = kernel[-radius] * in[i - radius];
  for (int t = 1 - radius; t <= radius; ++t) {
    const float w = kernel[t];
    for (std::int64_t i = 0; i < count; ++i) out[i] += w * in[i + t];
  }
}

SHAPE3D_LEVELSET_INLINE void norm(const float* __restrict x, const float* __restrict y,
                                  const float* __restrict z, std::int64_t count,
                                  float* __restrict out) {
  for (std::int64_t i = 0; i < count; ++i)
    out[i] = std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
}

/// exp(−x) = (exp(−x/32))^32, the inner one by Taylor's series to the fifth order: with x ≤ 10 its
/// relative error is under 0.3125⁶/6! · 1.4 = 1.9e-6 per factor at the end, 3e-5 in all, rounding
/// included.
SHAPE3D_LEVELSET_INLINE void bell_row(std::int64_t count, float scale, float limit,
                                      float* __restrict row) {
  for (std::int64_t i = 0; i < count; ++i) {
    const float d = row[i] * scale;
    const float x = std::min(d * d, 16.0F) * (-1.0F / 32.0F);
    float e =
        1.0F +
        x * (1.0F + x * (0.5F + x * (1.0F / 6.0F + x * (1.0F / 24.0F + x * (1.0F / 120.0F)))));
    e *= e;
    e *= e;
    e *= e;
    e *= e;
    e *= e;
    row[i] = std::abs(row[i]) < limit ? e : 0.0F;
  }
}

SHAPE3D_LEVELSET_INLINE Products sum_products(const float* __restrict a, const float* __restrict b,
                                              std::int64_t count) {
  float ab[16] = {}, bb[16] = {};
  std::int64_t i = 0;
  for (; i + 16 <= count; i += 16) {
    for (int lane = 0; lane < 16; ++lane) {
      ab[lane] += a[i + lane] * b[i + lane];
      bb[lane] += b[i + lane] * b[i + lane];
    }
  }
  int lane = 0;
  if (i + 8 <= count) {
    for (; lane < 8; ++lane) {
      ab[lane] += a[i + lane] * b[i + lane];
      bb[lane] += b[i + lane] * b[i + lane];
    }
    i += 8;
  }
  for (; i < count; ++i, ++lane) {
    ab[lane] += a[i] * b[i];
    bb[lane] += b[i] * b[i];
  }
  Products sum{0.0F, 0.0F};
  for (lane = 0; lane < 16; ++lane) {
    sum.ab += ab[lane];
    sum.bb += bb[lane];
  }
  return sum;
}

#if SHAPE3D_LEVELSET_X86
#define SHAPE3D_LEVELSET_AVX2_AND_PORTABLE(name, inner, parameters, ...)           \
  SHAPE3D_LEVELSET_TARGET_AVX2 void name##_avx2 parameters { inner(__VA_ARGS__); } \
  void name##_portable parameters { inner(__VA_ARGS__); }
#else
#define SHAPE3D_LEVELSET_AVX2_AND_PORTABLE(name, inner, parameters, ...) \
  void name##_portable parameters { inner(__VA_ARGS__); }
#endif
SHAPE3D_LEVELSET_AVX2_AND_PORTABLE(two, add_two,
                                   (const float* in, std::int64_t count, float wa, float* a,
                                    float wb, float* b),
                                   in, count, wa, a, wb, b)
SHAPE3D_LEVELSET_AVX2_AND_PORTABLE(one, add_one,
                                   (const float* in, std::int64_t count, float w, float* out), in,
                                   count, w, out)
SHAPE3D_LEVELSET_AVX2_AND_PORTABLE(convolve, row_kernel,
                                   (const float* in, std::int64_t count, const float* kernel,
                                    int radius, float* out),
                                   in, count, kernel, radius, out)
SHAPE3D_LEVELSET_AVX2_AND_PORTABLE(length, norm,
                                   (const float* x, const float* y, const float* z,
                                    std::int64_t count, float* out),
                                   x, y, z, count, out)
SHAPE3D_LEVELSET_AVX2_AND_PORTABLE(bells, bell_row,
                                   (std::int64_t count, float scale, float limit, float* row),
                                   count, scale, limit, row)
#undef SHAPE3D_LEVELSET_AVX2_AND_PORTABLE
#if SHAPE3D_LEVELSET_X86
SHAPE3D_LEVELSET_TARGET_AVX2 Products products_avx2(const float* a, const float* b,
                                                    std::int64_t count) {
  return sum_products(a, b, count);
}
#endif
Products products_portable(const float* a, const float* b, std::int64_t count) {
  return sum_products(a, b, count);
}

}  // namespace

void add_scaled(const float* in, std::int64_t count, float weight_a, float* a, float weight_b,
                float* b) {
  SHAPE3D_LEVELSET_DISPATCH(two, in, count, weight_a, a, weight_b, b);
}
void add_scaled(const float* in, std::int64_t count, float weight, float* out) {
  SHAPE3D_LEVELSET_DISPATCH(one, in, count, weight, out);
}
void convolve_row(const float* in, std::int64_t count, const float* kernel, int radius,
                  float* out) {
  SHAPE3D_LEVELSET_DISPATCH(convolve, in, count, kernel, radius, out);
}
void magnitude(const float* x, const float* y, const float* z, std::int64_t count, float* out) {
  SHAPE3D_LEVELSET_DISPATCH(length, x, y, z, count, out);
}
Products add_products(const float* a, const float* b, std::int64_t count) {
  return SHAPE3D_LEVELSET_DISPATCH(products, a, b, count);
}
void bell(std::int64_t count, float scale, float limit, float* row) {
  SHAPE3D_LEVELSET_DISPATCH(bells, count, scale, limit, row);
}

}  // namespace shape3d::levelset::detail
