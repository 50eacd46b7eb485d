#include "distance_rows.hpp"

#include <algorithm>
#include <cmath>

#include "isa.hpp"

namespace shape3d::levelset::detail {
namespace {

SHAPE3D_LEVELSET_INLINE int beside(const RowView& f, LevelOf level, int count, const Spacings& h,
                                   float limit, Far far, float* __restrict out) {
  const float *c = f.center, *ym = f.y_minus, *yp = f.y_plus, *zm = f.z_minus, *zp = f.z_plus;
  const float zero = level.level, sign = level.sign;
  const float ix = h.inverse[0], iy = h.inverse[1], iz = h.inverse[2];
  // Crossings nearer than 1e-6 of a spacing count as so near: 1/t stays finite and no node that is
  // not zero gets distance 0.
  const float cap = 1e6F;
  const float far_limit = far == Far::kept ? limit : 0.0F;
  int found = 0;
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
    const float plane = std::sqrt(x * x + y * y + z * z), nearest = std::max(x, std::max(y, z));
    const float inverse = two_sided <= 0.0F ? nearest : plane;
    const float elsewhere = std::abs(v) < far_limit ? std::abs(v) : limit;
    const bool is_beside = least <= 0.0F;
    const float d = is_beside ? std::min(1.0F / inverse, limit) : elsewhere;
    found += is_beside | (v == 0.0F) ? 1 : 0;
    const float signed_d = v < 0.0F ? -d : d;
    out[i] = v == 0.0F ? 0.0F : signed_d;
  }
  return found;
}

/// Least u ≥ the neighbours it uses with Σ max((u − m)/h, 0)² = 1.
///
/// With m sorted, the neighbours used are the first one, two or three. All is relative to the
/// least; equal neighbours need no care: a pair is used only when the third is farther than its
/// solution.
SHAPE3D_LEVELSET_INLINE void relax(const RowView& d, int count, const Spacings& h, float limit,
                                   float* __restrict out) {
  const float *c = d.center, *ym = d.y_minus, *yp = d.y_plus, *zm = d.z_minus, *zp = d.z_plus;
  const float hx = h.h[0], hy = h.h[1], hz = h.h[2];
  const float wx = h.weight[0], wy = h.weight[1], wz = h.weight[2];
  const float all = 1.0F / (wx + wy + wz);
  for (int i = 0; i < count; ++i) {
    const float v = c[i], s = v < 0.0F ? -1.0F : 1.0F;
    const float x = std::min(s * c[i - 1], s * c[i + 1]), y = std::min(s * ym[i], s * yp[i]),
                z = std::min(s * zm[i], s * zp[i]);
    const float low = std::min(x, y), high = std::max(x, y);
    const float least = std::min(low, z), greatest = std::max(high, z);
    const float middle = std::max(low, std::min(high, z));
    const float one = std::min(x + hx, std::min(y + hy, z + hz));
    const float dx = x - least, dy = y - least, dz = z - least;
    const float sx = wx * dx, sy = wy * dy, sz = wz * dz;
    const float sum3 = sx + sy + sz, square3 = sx * dx + sy * dy + sz * dz;
    const float w3 = wx + wy + wz;
    const float three =
        (sum3 + std::sqrt(std::max(sum3 * sum3 - w3 * (square3 - 1.0F), 0.0F))) * all;
    // Without the farthest.
    const float ux = x < greatest ? wx : 0.0F, uy = y < greatest ? wy : 0.0F,
                uz = z < greatest ? wz : 0.0F;
    const float ex = x < greatest ? dx : 0.0F, ey = y < greatest ? dy : 0.0F,
                ez = z < greatest ? dz : 0.0F;
    const float w2 = ux + uy + uz, sum2 = ux * ex + uy * ey + uz * ez;
    const float square2 = ux * ex * ex + uy * ey * ey + uz * ez * ez;
    const float two = (sum2 + std::sqrt(std::max(sum2 * sum2 - w2 * (square2 - 1.0F), 0.0F))) / w2;
    const float several = two <= greatest - least ? two : three;
    const float u = one <= middle ? one : least + several;
    const float value = least <= 0.0F ? std::abs(v) : std::min(u, limit);  // beside: kept
    out[i] = v == 0.0F ? 0.0F : s * value;
  }
}

#if SHAPE3D_LEVELSET_X86
SHAPE3D_LEVELSET_TARGET_AVX2 int beside_avx2(const RowView& f, LevelOf level, int count,
                                             const Spacings& h, float limit, Far far, float* out) {
  return beside(f, level, count, h, limit, far, out);
}
SHAPE3D_LEVELSET_TARGET_AVX2 void relax_avx2(const RowView& d, int count, const Spacings& h,
                                             float limit, float* out) {
  relax(d, count, h, limit, out);
}
#endif
int beside_portable(const RowView& f, LevelOf level, int count, const Spacings& h, float limit,
                    Far far, float* out) {
  return beside(f, level, count, h, limit, far, out);
}
void relax_portable(const RowView& d, int count, const Spacings& h, float limit, float* out) {
  relax(d, count, h, limit, out);
}

}  // namespace

int distance_beside(const RowView& field, LevelOf level, int count, const Spacings& spacings,
                    float limit, Far far, float* out) {
  return SHAPE3D_LEVELSET_DISPATCH(beside, field, level, count, spacings, limit, far, out);
}

void relax_distance(const RowView& distance, int count, const Spacings& spacings, float limit,
                    float* out) {
  SHAPE3D_LEVELSET_DISPATCH(relax, distance, count, spacings, limit, out);
}

}  // namespace shape3d::levelset::detail
