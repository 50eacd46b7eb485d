#pragma once

#include <cstdint>

namespace shape3d::levelset::detail {

/// a[i] += weight_a · in[i] and b[i] += weight_b · in[i].
void add_scaled(const float* in, std::int64_t count, float weight_a, float* a, float weight_b,
                float* b);

/// out[i] += weight · in[i].
void add_scaled(const float* in, std::int64_t count, float weight, float* out);

/// out[i] = Σ kernel[t] · in[i + t], t = −radius … radius; kernel points to its middle.
void convolve_row(const float* in, std::int64_t count, const float* kernel, int radius, float* out);

/// out[i] = √(x² + y² + z²).
void magnitude(const float* x, const float* y, const float* z, std::int64_t count, float* out);

/// Σ a·b and Σ b·b, in an order that no instruction set changes.
struct Products {
  float ab, bb;
};
Products add_products(const float* a, const float* b, std::int64_t count);

/// In place: row[i] = exp(−(row[i] · scale)²), 0 where |row[i]| ≥ limit. Relative error under 4e-5
/// for exponents up to 10.
void bell(std::int64_t count, float scale, float limit, float* row);

}  // namespace shape3d::levelset::detail
