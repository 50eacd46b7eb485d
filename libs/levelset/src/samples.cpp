#include "samples.hpp"

#include <vector>

#include "parallel.hpp"

namespace shape3d::levelset::detail {
namespace {

/// x·0 is 0 for finite x and NaN otherwise; sums of it become vectors.
template <class T>
bool all_finite(const T* values, std::int64_t count, std::int64_t stride) {
  T sum[8] = {};
  std::int64_t i = 0;
  if (stride == 1) {
    for (; i + 8 <= count; i += 8)
      for (int lane = 0; lane < 8; ++lane) sum[lane] += values[i + lane] * T{0};
  }
  for (; i < count; ++i) sum[0] += values[i * stride] * T{0};
  T all{0};
  for (const T lane : sum) all += lane;
  return all == T{0};
}

}  // namespace

void require_finite(const ImageView& view, int threads) {
  visit_sample_type(view.type, [&](auto sample) {
    using T = decltype(sample);
    if constexpr (std::is_floating_point_v<T>) {
      const Rows<T> rows(view);
      std::vector<char> bad(static_cast<std::size_t>(view.dims[2]), 0);
      parallel_for(view.dims[2], threads, [&](std::int64_t k) {
        for (std::int64_t j = 0; j < view.dims[1] && bad[k] == 0; ++j)
          bad[k] = all_finite(rows.row(j, k), view.dims[0], rows.stride()) ? 0 : 1;
      });
      for (std::int64_t k = 0; k < view.dims[2]; ++k) {
        if (bad[k] == 0) continue;
        for (std::int64_t j = 0; j < view.dims[1]; ++j) {
          for (std::int64_t i = 0; i < view.dims[0]; ++i) {
            const T value = rows.row(j, k)[i * rows.stride()];
            if (!std::isfinite(value)) refuse_sample(i, j, k, static_cast<double>(value));
          }
        }
      }
    }
  });
}

void require_finite(const Field& field, const char* name) {
  if (all_finite(field.data(), field.size(), 1)) return;
  for (Eigen::Index i = 0; i < field.size(); ++i) {
    if (!std::isfinite(field[i])) {
      refuse(std::string(name) + "[" + text(static_cast<std::int64_t>(i)) + "]",
             std::isnan(field[i]) ? "NaN" : text(field[i]), "a finite number");
    }
  }
}

}  // namespace shape3d::levelset::detail
