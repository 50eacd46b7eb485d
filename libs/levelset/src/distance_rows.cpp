#include "distance_rows.hpp"

#include <algorithm>
#include <cmath>

#include "isa.hpp"

namespace shape3d::levelset::detail {
namespace {

/// `marks` gets 1 for each node beside the zero set, else 0.
SHAPE3D_LEVELSET_INLINE void beside(const float* c, std::int64_t row, std::int64_t slice,
                                    LevelOf level, int count, const Spacings& h, float limit,
                                    float far_limit, float* __restrict out,
                                    std::int32_t* __restrict marks) {
  const float *ym = c - row, *yp = c + row, *zm = c - slice, *zp = c + slice;
  const float zero = level.level, sign = level.sign;
  const float ix = h.inverse[0], iy = h.inverse[1], iz = h.inverse[2];
  // Crossings nearer than 1e-6 of a spacing count as so near: 1/t stays finite and no node that is
  // not zero gets distance 0.
  const float cap = 1e6F;
  for (int i = 0; i < count; ++i) {
    const float v = sign * (c[i] - zero);
    const float s = v < 0.0F ? -sign : sign;
    const float r = 1.0F / std::max(std::abs(v), 1e-30F);
    const float xm = s * (c[i - 1] - zero), xp = s * (c[i + 1] - zero);
    const float am = s * (ym[i] - zero), ap = s * (yp[i] - zero);
    const float bm = s * (zm[i] - zero), bp = s * (zp[i] - zero);
    // Slope along an axis over |v|, times h: (|v| − n)/|v| towards the nearer crossing, and where
    // there is none, towards the lower neighbour.
    const float x = std::min(std::max(1.0F - std::min(xm, xp) * r, 0.0F), cap) * ix;
    const float y = std::min(std::max(1.0F - std::min(am, ap) * r, 0.0F), cap) * iy;
    const float z = std::min(std::max(1.0F - std::min(bm, bp) * r, 0.0F), cap) * iz;
    const float least = std::min(std::min(xm, xp), std::min(std::min(am, ap), std::min(bm, bp)));
    const float two_sided =
        std::min(std::max(xm, xp), std::min(std::max(am, ap), std::max(bm, bp)));
    const float nearest = std::max(x, std::max(y, z));
    const float square = two_sided <= 0.0F ? nearest * nearest : x * x + y * y + z * z;
    const float elsewhere = std::abs(v) < far_limit ? std::abs(v) : limit;
    const bool is_beside = least <= 0.0F, is_zero = v == 0.0F;
    const float d = is_beside ? std::min(1.0F / std::sqrt(square), limit) : elsewhere;
    const float signed_d = v < 0.0F ? -d : d;
    out[i] = is_zero ? 0.0F : signed_d;
    marks[i] = is_beside || is_zero ? 1 : 0;
  }
}

SHAPE3D_LEVELSET_INLINE Beside beside_rows(const TileRows& rows, RowMask mask, const float* field,
                                           LevelOf level, const Spacings& h, float limit, Far far,
                                           float* out) {
  const float far_limit = far == Far::kept ? limit : 0.0F;
  Beside found;
  for (RowMask rest = mask & rows.all; rest != 0; rest &= rest - 1) {
    const int bit = __builtin_ctzll(rest);
    const std::int64_t at = rows.padded + (bit & 7) * rows.row + (bit >> 3) * rows.slice;
    std::int32_t marks[kTileX] = {};
    if (rows.count == kTileX) {
      beside(field + at, rows.row, rows.slice, level, kTileX, h, limit, far_limit, out + at, marks);
    } else {
      beside(field + at, rows.row, rows.slice, level, rows.count, h, limit, far_limit, out + at,
             marks);
    }
    const int low = marks[0] + marks[1] + marks[2] + marks[3],
              high = marks[4] + marks[5] + marks[6] + marks[7];
    found.rows.low |= static_cast<RowMask>(low != 0) << bit;
    found.rows.high |= static_cast<RowMask>(high != 0) << bit;
    found.by_row[static_cast<std::size_t>(bit)] = static_cast<std::uint8_t>(low + high);
    found.nodes += low + high;
  }
  return found;
}

/// Least u ≥ the neighbours it uses with Σ max((u − m)/h, 0)² = 1.
///
/// With the axes in the order of their neighbours, a ≤ b ≤ c: an axis is used when the solution
/// without it and those after it is above its neighbour, that is, Σ ((c − m)/h)² < 1 over those
/// before.
SHAPE3D_LEVELSET_INLINE void relax(const float* cell, std::int64_t row, std::int64_t slice,
                                   int count, const Spacings& h, float limit,
                                   float* __restrict out) {
  const float *ym = cell - row, *yp = cell + row, *zm = cell - slice, *zp = cell + slice;
  const float wx = h.weight[0], wy = h.weight[1], wz = h.weight[2];
  for (int i = 0; i < count; ++i) {
    const float v = cell[i], s = v < 0.0F ? -1.0F : 1.0F;
    const float x = std::min(s * cell[i - 1], s * cell[i + 1]), y = std::min(s * ym[i], s * yp[i]),
                z = std::min(s * zm[i], s * zp[i]);
    const float low = std::min(x, y), high = std::max(x, y);
    const float w_low = y < x ? wy : wx, w_high = y < x ? wx : wy;
    const float middle = std::min(high, z), c = std::max(high, z);
    const float w_middle = z < high ? wz : w_high, wc = z < high ? w_high : wz;
    const float a = std::min(low, middle), b = std::max(low, middle);
    const float wa = middle < low ? w_middle : w_low, wb = middle < low ? w_low : w_middle;
    const float db = b - a, dc = c - a, cb = c - b;
    const float ub = wa * db * db < 1.0F ? wb : 0.0F;
    const float uc = wa * dc * dc + wb * cb * cb < 1.0F ? wc : 0.0F;
    const float w = wa + ub + uc, pb = ub * db, pc = uc * dc, sum = pb + pc;
    const float square = pb * db + pc * dc;
    const float u = a + (sum + std::sqrt(std::max(sum * sum - w * (square - 1.0F), 0.0F))) / w;
    const float value = a <= 0.0F ? std::abs(v) : std::min(u, limit);  // beside: kept
    out[i] = v == 0.0F ? 0.0F : s * value;
  }
}

SHAPE3D_LEVELSET_INLINE void relax_rows(const TileRows& rows, RowMask mask, const float* distance,
                                        const Spacings& h, float limit, float* out) {
  for (RowMask rest = mask & rows.all; rest != 0; rest &= rest - 1) {
    const int bit = __builtin_ctzll(rest);
    const std::int64_t at = rows.padded + (bit & 7) * rows.row + (bit >> 3) * rows.slice;
    if (rows.count == kTileX) {
      relax(distance + at, rows.row, rows.slice, kTileX, h, limit, out + at);
    } else {
      relax(distance + at, rows.row, rows.slice, rows.count, h, limit, out + at);
    }
  }
}

#if SHAPE3D_LEVELSET_X86
SHAPE3D_LEVELSET_TARGET_AVX2 Beside beside_avx2(const TileRows& rows, RowMask mask,
                                                const float* field, LevelOf level,
                                                const Spacings& h, float limit, Far far,
                                                float* out) {
  return beside_rows(rows, mask, field, level, h, limit, far, out);
}
SHAPE3D_LEVELSET_TARGET_AVX2 void relax_avx2(const TileRows& rows, RowMask mask,
                                             const float* distance, const Spacings& h, float limit,
                                             float* out) {
  relax_rows(rows, mask, distance, h, limit, out);
}
#endif
Beside beside_portable(const TileRows& rows, RowMask mask, const float* field, LevelOf level,
                       const Spacings& h, float limit, Far far, float* out) {
  return beside_rows(rows, mask, field, level, h, limit, far, out);
}
void relax_portable(const TileRows& rows, RowMask mask, const float* distance, const Spacings& h,
                    float limit, float* out) {
  relax_rows(rows, mask, distance, h, limit, out);
}

}  // namespace

Beside distance_beside(const TileRows& rows, RowMask mask, const float* field, LevelOf level,
                       const Spacings& spacings, float limit, Far far, float* out) {
  return SHAPE3D_LEVELSET_DISPATCH(beside, rows, mask, field, level, spacings, limit, far, out);
}

void relax_distance(const TileRows& rows, RowMask mask, const float* distance,
                    const Spacings& spacings, float limit, float* out) {
  SHAPE3D_LEVELSET_DISPATCH(relax, rows, mask, distance, spacings, limit, out);
}

}  // namespace shape3d::levelset::detail
