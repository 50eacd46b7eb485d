#include "advance_rows.hpp"

#include <algorithm>
#include <cmath>

#include "isa.hpp"

namespace shape3d::levelset::detail {
namespace {

/// κ·|∇ψ| from central differences.
template <CurvatureTerm Term>
SHAPE3D_LEVELSET_INLINE float curvature(const float* c, std::int64_t i, std::int64_t row,
                                        std::int64_t slice, float ix, float iy, float iz,
                                        float bound) {
  const float *ym = c - row, *yp = c + row, *zm = c - slice, *zp = c + slice;
  const float px = 0.5F * ix * (c[i + 1] - c[i - 1]), py = 0.5F * iy * (yp[i] - ym[i]),
              pz = 0.5F * iz * (zp[i] - zm[i]);
  const float two = 2.0F * c[i];
  const float xx = ix * ix * (c[i + 1] - two + c[i - 1]), yy = iy * iy * (yp[i] - two + ym[i]),
              zz = iz * iz * (zp[i] - two + zm[i]);
  const float xy = 0.25F * ix * iy * ((yp[i + 1] - yp[i - 1]) - (ym[i + 1] - ym[i - 1]));
  const float xz = 0.25F * ix * iz * ((zp[i + 1] - zp[i - 1]) - (zm[i + 1] - zm[i - 1]));
  const float yz = 0.25F * iy * iz * ((zp[i + row] - zp[i - row]) - (zm[i + row] - zm[i - row]));
  const float x2 = px * px, y2 = py * py, z2 = pz * pz;
  const float square = x2 + y2 + z2, safe = std::max(square, 1e-12F);
  const float length = std::sqrt(square), inverse = 1.0F / std::sqrt(safe);
  const float sum = ((yy + zz) * x2 + (xx + zz) * y2 + (xx + yy) * z2 -
                     2.0F * (px * py * xy + px * pz * xz + py * pz * yz)) *
                    (inverse * inverse * inverse);
  float kappa = sum;
  if constexpr (Term == CurvatureTerm::minimal) {
    const float gauss =
        (x2 * (yy * zz - yz * yz) + y2 * (xx * zz - xz * xz) + z2 * (xx * yy - xy * xy) +
         2.0F * (px * py * (xz * yz - xy * zz) + py * pz * (xy * xz - yz * xx) +
                 px * pz * (xy * yz - xz * yy))) *
        (inverse * inverse * inverse * inverse);
    const float half = 0.5F * sum, apart = std::sqrt(std::max(half * half - gauss, 0.0F));
    kappa = half < 0.0F ? half + apart : half - apart;
  }
  return std::min(std::max(kappa, -bound), bound) * length;
}

template <CurvatureTerm Term>
SHAPE3D_LEVELSET_INLINE void advance_nodes(const float* __restrict c, std::int64_t row,
                                           std::int64_t slice, const float* __restrict speed,
                                           const float* __restrict factor, int count,
                                           const Spacings& h, const Step& step,
                                           float* __restrict out) {
  const float *ym = c - row, *yp = c + row, *zm = c - slice, *zp = c + slice;
  const float ix = h.inverse[0], iy = h.inverse[1], iz = h.inverse[2];
  const float dt = step.dt, limit = step.limit, bound = step.max_curvature;
  const float epsilon = step.curvature;
  for (int i = 0; i < count; ++i) {
    const float f = speed[i], s = f < 0.0F ? -1.0F : 1.0F, v = s * c[i];
    // Differences towards the side the front comes from; for F < 0 everything is mirrored.
    const float x = ix * std::max(v - std::min(s * c[i - 1], s * c[i + 1]), 0.0F);
    const float y = iy * std::max(v - std::min(s * ym[i], s * yp[i]), 0.0F);
    const float z = iz * std::max(v - std::min(s * zm[i], s * zp[i]), 0.0F);
    float change = -f * std::sqrt(x * x + y * y + z * z);
    if constexpr (Term != CurvatureTerm::none) {
      const float bent = curvature<Term>(c, i, row, slice, ix, iy, iz, bound);
      change += epsilon * factor[i] * bent;
    }
    out[i] = std::min(std::max(c[i] + dt * change, -limit), limit);
  }
}

SHAPE3D_LEVELSET_INLINE void advance_any(const float* psi, std::int64_t row, std::int64_t slice,
                                         const float* advance, const float* factor, int count,
                                         const Spacings& h, const Step& step, float* out) {
  switch (step.term) {
    case CurvatureTerm::none:
      return advance_nodes<CurvatureTerm::none>(psi, row, slice, advance, factor, count, h, step,
                                                out);
    case CurvatureTerm::mean:
      return advance_nodes<CurvatureTerm::mean>(psi, row, slice, advance, factor, count, h, step,
                                                out);
    case CurvatureTerm::minimal:
      return advance_nodes<CurvatureTerm::minimal>(psi, row, slice, advance, factor, count, h, step,
                                                   out);
  }
}

SHAPE3D_LEVELSET_INLINE void add_to(const float* __restrict before, const float* __restrict after,
                                    int count, float slope, Change& change) {
  int crossed = 0, inside = 0;
  for (int i = 0; i < count; ++i) {
    crossed += (before[i] <= 0.0F) != (after[i] <= 0.0F) ? 1 : 0;
    inside += after[i] <= 0.0F ? 1 : 0;
  }
  change.crossed += crossed;
  change.inside += inside;
  const auto part = [slope](float psi) {
    return std::min(std::max(0.5F - psi * slope, 0.0F), 1.0F);
  };
  float lanes[16];
  std::copy_n(change.lanes, 16, lanes);
  int i = 0;
  for (; i + 16 <= count; i += 16)
    for (int lane = 0; lane < 16; ++lane) lanes[lane] += part(after[i + lane]);
  for (int lane = 0; i < count; ++i, ++lane) lanes[lane] += part(after[i]);
  std::copy_n(lanes, 16, change.lanes);
}

SHAPE3D_LEVELSET_INLINE int near_nodes(const float* psi, int count, float limit) {
  int found = 0;
  for (int i = 0; i < count; ++i) found += std::abs(psi[i]) < limit ? 1 : 0;
  return found;
}

#if SHAPE3D_LEVELSET_X86
SHAPE3D_LEVELSET_TARGET_AVX2 int near_avx2(const float* psi, int count, float limit) {
  return near_nodes(psi, count, limit);
}
SHAPE3D_LEVELSET_TARGET_AVX2 void advance_avx2(const float* psi, std::int64_t row,
                                               std::int64_t slice, const float* advance,
                                               const float* factor, int count, const Spacings& h,
                                               const Step& step, float* out) {
  advance_any(psi, row, slice, advance, factor, count, h, step, out);
}
SHAPE3D_LEVELSET_TARGET_AVX2 void change_avx2(const float* before, const float* after, int count,
                                              float slope, Change& change) {
  add_to(before, after, count, slope, change);
}
#endif
int near_portable(const float* psi, int count, float limit) {
  return near_nodes(psi, count, limit);
}
void advance_portable(const float* psi, std::int64_t row, std::int64_t slice, const float* advance,
                      const float* factor, int count, const Spacings& h, const Step& step,
                      float* out) {
  advance_any(psi, row, slice, advance, factor, count, h, step, out);
}
void change_portable(const float* before, const float* after, int count, float slope,
                     Change& change) {
  add_to(before, after, count, slope, change);
}

}  // namespace

void advance_row(const float* psi, std::int64_t row, std::int64_t slice, const float* advance,
                 const float* factor, int count, const Spacings& spacings, const Step& step,
                 float* out) {
  SHAPE3D_LEVELSET_DISPATCH(advance, psi, row, slice, advance, factor, count, spacings, step, out);
}

int count_near(const float* psi, int count, float limit) {
  return SHAPE3D_LEVELSET_DISPATCH(near, psi, count, limit);
}

void add_change(const float* before, const float* after, int count, float slope, Change& change) {
  SHAPE3D_LEVELSET_DISPATCH(change, before, after, count, slope, change);
}

}  // namespace shape3d::levelset::detail
