#pragma once

#include <cstdint>

namespace shape3d::levelset::detail {

/// k_I = 1/(1 + (|∇|·inverse_scale)²) of a row.
void square_factors(const float* gradient, std::int64_t count, float inverse_scale, float* out);

/// k = max(fuzzy_factor(k_I, 1 − y), least) of a row; y = 0: max(k_I, least).
/// @param factors  k_I, becomes k.
/// @param bells  Y, or null: no boundary detector.
void fuzzy_factors(const float* bells, std::int64_t count, float least, float* factors);

}  // namespace shape3d::levelset::detail
