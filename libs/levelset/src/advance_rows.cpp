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
                                           float* __restrict out, int* __restrict crossed,
                                           int* __restrict inside) {
  const float *ym = c - row, *yp = c + row, *zm = c - slice, *zp = c + slice;
  const float ix = h.inverse[0], iy = h.inverse[1], iz = h.inverse[2];
  const float dt = step.dt, limit = step.limit, bound = step.max_curvature;
  const float epsilon = step.curvature, gain = step.gain, most = step.most;
  for (int i = 0; i < count; ++i) {
    const float f = std::min(std::max(gain * speed[i], -most), most), s = f < 0.0F ? -1.0F : 1.0F,
                v = s * c[i];
    // Differences towards the side the front comes from; for F < 0 everything is mirrored.
    const float x = ix * std::max(v - std::min(s * c[i - 1], s * c[i + 1]), 0.0F);
    const float y = iy * std::max(v - std::min(s * ym[i], s * yp[i]), 0.0F);
    const float z = iz * std::max(v - std::min(s * zm[i], s * zp[i]), 0.0F);
    float change = -f * std::sqrt(x * x + y * y + z * z);
    if constexpr (Term != CurvatureTerm::none) {
      const float bent = curvature<Term>(c, i, row, slice, ix, iy, iz, bound);
      change += epsilon * factor[i] * bent;
    }
    const float after = std::min(std::max(c[i] + dt * change, -limit), limit);
    const int was = c[i] <= 0.0F ? 1 : 0, is = after <= 0.0F ? 1 : 0;
    crossed[i] += was ^ is;
    inside[i] += is - was;
    out[i] = after;
  }
}

template <CurvatureTerm Term>
SHAPE3D_LEVELSET_INLINE Change advance_tile(const TileRows& rows, RowMask mask, const float* psi,
                                            const float* speed, const float* factor,
                                            const Spacings& h, const Step& step, float* out) {
  int crossed[kTileX] = {}, inside[kTileX] = {};
  for (RowMask rest = mask & rows.all; rest != 0; rest &= rest - 1) {
    const int bit = __builtin_ctzll(rest), j = bit & 7, k = bit >> 3;
    const std::int64_t at = rows.padded + j * rows.row + k * rows.slice,
                       dense = rows.dense + j * rows.dense_row + k * rows.dense_slice;
    if (rows.count == kTileX) {
      advance_nodes<Term>(psi + at, rows.row, rows.slice, speed + dense, factor + dense, kTileX, h,
                          step, out + at, crossed, inside);
    } else {
      advance_nodes<Term>(psi + at, rows.row, rows.slice, speed + dense, factor + dense, rows.count,
                          h, step, out + at, crossed, inside);
    }
  }
  Change change;
  for (int lane = 0; lane < kTileX; ++lane) {
    change.crossed += crossed[lane];
    change.inside += inside[lane];
  }
  return change;
}

SHAPE3D_LEVELSET_INLINE Change advance_any(const TileRows& rows, RowMask mask, const float* psi,
                                           const float* speed, const float* factor,
                                           const Spacings& h, const Step& step, float* out) {
  switch (step.term) {
    case CurvatureTerm::mean:
      return advance_tile<CurvatureTerm::mean>(rows, mask, psi, speed, factor, h, step, out);
    case CurvatureTerm::minimal:
      return advance_tile<CurvatureTerm::minimal>(rows, mask, psi, speed, factor, h, step, out);
    case CurvatureTerm::none:
      break;
  }
  return advance_tile<CurvatureTerm::none>(rows, mask, psi, speed, factor, h, step, out);
}

/// One row, its lanes added in pairs of halves.
SHAPE3D_LEVELSET_INLINE void measure_row(const float* __restrict psi, int count, float w,
                                         float slope, float& row_volume, int& row_near,
                                         int& row_inside) {
  float volume[kTileX] = {};
  int near[kTileX] = {}, inside[kTileX] = {};
  for (int i = 0; i < count; ++i) {
    volume[i] = std::min(std::max(0.5F - psi[i] * slope, 0.0F), 1.0F);
    near[i] = std::abs(psi[i]) < w ? 1 : 0;
    inside[i] = psi[i] <= 0.0F ? 1 : 0;
  }
  for (int half = kTileX / 2; half > 0; half /= 2) {
    for (int i = 0; i < half; ++i) {
      volume[i] += volume[i + half];
      near[i] += near[i + half];
      inside[i] += inside[i + half];
    }
  }
  row_volume = volume[0];
  row_near = near[0];
  row_inside = inside[0];
}

SHAPE3D_LEVELSET_INLINE Measures measure_tile(const TileRows& rows, RowMask mask, const float* psi,
                                              float w, RowMeasures& by_row) {
  const float slope = 0.5F / w;
  Measures sum;
  for (RowMask rest = mask & rows.all; rest != 0; rest &= rest - 1) {
    const int bit = __builtin_ctzll(rest);
    const float* row = psi + rows.padded + (bit & 7) * rows.row + (bit >> 3) * rows.slice;
    float volume = 0.0F;
    int near = 0, inside = 0;
    if (rows.count == kTileX) {
      measure_row(row, kTileX, w, slope, volume, near, inside);
    } else {
      measure_row(row, rows.count, w, slope, volume, near, inside);
    }
    by_row.volume[bit] = volume;
    by_row.near[bit] = static_cast<std::uint8_t>(near);
    sum.volume += static_cast<double>(volume);
    sum.near += near;
    sum.inside += inside;
  }
  return sum;
}

#if SHAPE3D_LEVELSET_X86
SHAPE3D_LEVELSET_TARGET_AVX2 Change advance_avx2(const TileRows& rows, RowMask mask,
                                                 const float* psi, const float* speed,
                                                 const float* factor, const Spacings& h,
                                                 const Step& step, float* out) {
  return advance_any(rows, mask, psi, speed, factor, h, step, out);
}
SHAPE3D_LEVELSET_TARGET_AVX2 Measures measure_avx2(const TileRows& rows, RowMask mask,
                                                   const float* psi, float w, RowMeasures& by_row) {
  return measure_tile(rows, mask, psi, w, by_row);
}
#endif
Change advance_portable(const TileRows& rows, RowMask mask, const float* psi, const float* speed,
                        const float* factor, const Spacings& h, const Step& step, float* out) {
  return advance_any(rows, mask, psi, speed, factor, h, step, out);
}
Measures measure_portable(const TileRows& rows, RowMask mask, const float* psi, float w,
                          RowMeasures& by_row) {
  return measure_tile(rows, mask, psi, w, by_row);
}

}  // namespace

Change advance_rows(const TileRows& rows, RowMask mask, const float* psi, const float* advance,
                    const float* factor, const Spacings& spacings, const Step& step, float* out) {
  return SHAPE3D_LEVELSET_DISPATCH(advance, rows, mask, psi, advance, factor, spacings, step, out);
}

Measures measure_rows(const TileRows& rows, RowMask mask, const float* psi, float w,
                      RowMeasures& by_row) {
  return SHAPE3D_LEVELSET_DISPATCH(measure, rows, mask, psi, w, by_row);
}

}  // namespace shape3d::levelset::detail
