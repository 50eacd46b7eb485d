#include "shape3d/levelset/speed.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "boundary.hpp"
#include "message.hpp"
#include "parallel.hpp"
#include "samples.hpp"
#include "speed_rows.hpp"

namespace shape3d::levelset {
namespace {

using detail::text;

/// F_A by intensity: a table of tanh((Λ(u) − λ)/2) between the outer means, linear between steps.
class AdvectionTable {
 public:
  AdvectionTable(const IntensityModel& model, double lambda) {
    const Eigen::ArrayXd& means = model.mixture().means;
    const double least = means[0], span = means[means.size() - 1] - least;
    values_.resize(kSteps + 2);
    for (int n = 0; n <= kSteps; ++n) {
      values_[n] =
          static_cast<float>(std::tanh(0.5 * (model.log_odds(least + span * n / kSteps) - lambda)));
    }
    values_[kSteps + 1] = values_[kSteps];
    least_ = static_cast<float>(least);
    scale_ = span > 0.0 ? static_cast<float>(kSteps / span) : 0.0F;
  }
  float operator()(float u) const {
    const float at = std::min(std::max((u - least_) * scale_, 0.0F), static_cast<float>(kSteps));
    const int n = static_cast<int>(at);
    const float t = at - static_cast<float>(n);
    return values_[n] + t * (values_[n + 1] - values_[n]);
  }

 private:
  static constexpr int kSteps = 16384;
  Eigen::ArrayXf values_;
  float least_ = 0.0F, scale_ = 0.0F;
};

/// A smooth function of one variable on [0, 1], tabulated.
template <class Function>
std::vector<float> tabulate(const Function& function) {
  constexpr int kSteps = 1024;
  std::vector<float> table(kSteps + 2);
  for (int n = 0; n <= kSteps; ++n) table[n] = function(static_cast<float>(n) / kSteps);
  table[kSteps + 1] = table[kSteps];
  return table;
}

void check(const ImageView& image, const Field& gradient, const IntensityModel& model,
           const SpeedOptions& options) {
  using detail::require;
  validate(image);
  if (options.method != Method::intensity || gradient.size() > 0) {
    if (gradient.size() != image.grid().size()) {
      detail::refuse("gradient: size", text(static_cast<std::int64_t>(gradient.size())),
                     text(image.grid().size()) + ", one value a sample");
    }
  }
  require(std::isfinite(options.exponent) && options.exponent > 0.0, "exponent", options.exponent,
          "a finite positive number");
  require(options.gradient_quantile > 0.0 && options.gradient_quantile < 1.0, "gradient_quantile",
          options.gradient_quantile, "a number between 0 and 1");
  require(std::isfinite(options.boundary_width) && options.boundary_width >= 0.0, "boundary_width",
          options.boundary_width, "a finite number of mm that is not negative");
  require(options.direction == -1.0 || options.direction == 1.0, "direction", options.direction,
          "-1 (shrink) or 1 (expand)");
  require(options.min_factor >= 0.0 && options.min_factor <= 1.0, "min_factor", options.min_factor,
          "a number from 0 to 1");
  if (options.method != Method::gradient && !model.two_sided()) {
    detail::refuse("model", "one with all classes on one side", "classes inside and outside");
  }
}

}  // namespace

float gradient_factor(float magnitude, float scale, float exponent) {
  if (!(scale > 0.0F)) return 1.0F;
  return 1.0F / (1.0F + std::pow(magnitude / scale, exponent));
}

double quantile(const Field& field, double q) {
  if (field.size() == 0) return 0.0;
  const float greatest = field.maxCoeff();
  if (!(greatest > 0.0F)) return 0.0;
  constexpr int kBins = 4096;
  std::vector<std::int64_t> counts(kBins + 1, 0);
  const float scale = kBins / greatest;
  for (Eigen::Index i = 0; i < field.size(); ++i)
    ++counts[static_cast<std::size_t>(std::max(field[i], 0.0F) * scale)];
  const double wanted = q * static_cast<double>(field.size());
  double below = 0.0;
  for (int b = 0; b <= kBins; ++b) {
    below += static_cast<double>(counts[static_cast<std::size_t>(b)]);
    if (below >= wanted) return (b + 0.5) / scale;
  }
  return greatest;
}

Speed make_speed(const ImageView& image, const Field& gradient, const IntensityModel& model,
                 double lambda, bool factor, const SpeedOptions& options) {
  check(image, gradient, model, options);
  const int threads = detail::resolve_threads(options.threads);
  detail::require_finite(image, threads);
  const Grid grid = image.grid();
  Speed speed;
  speed.advance.resize(grid.size());
  if (factor) speed.factor.resize(grid.size());

  const bool by_gradient = options.method != Method::intensity;
  const bool by_boundary = options.method == Method::combined;
  if (by_gradient) speed.gradient_scale = quantile(gradient, options.gradient_quantile);
  const auto scale = static_cast<float>(speed.gradient_scale);
  const auto exponent = static_cast<float>(options.exponent);
  const bool squared = options.exponent == 2.0 && scale > 0.0F;
  // k_I against |∇| up to 16 scales; beyond it is under 16^-m.
  constexpr float kReach = 16.0F;
  const std::vector<float> gradient_table =
      tabulate([&](float x) { return gradient_factor(kReach * x * scale, scale, exponent); });
  const double width = options.boundary_width > 0.0 ? options.boundary_width : grid.mean_spacing();
  if (by_boundary) speed.advance = detail::boundary_bells(image, model, lambda, width, threads);
  const AdvectionTable advection =
      options.method == Method::gradient
          ? AdvectionTable(IntensityModel({Eigen::ArrayXd::Ones(1), Eigen::ArrayXd::Zero(1),
                                           Eigen::ArrayXd::Ones(1)},
                                          {true}),
                           0.0)
          : AdvectionTable(model, by_boundary ? lambda : 0.0);
  const auto least = static_cast<float>(options.min_factor);
  const auto constant = static_cast<float>(options.direction);

  detail::parallel_for(grid.dims[2], threads, [&](std::int64_t k) {
    const std::int64_t count = grid.dims[0];
    std::vector<float> row(static_cast<std::size_t>(count)), factors(row.size(), 1.0F);
    for (std::int64_t j = 0; j < grid.dims[1]; ++j) {
      detail::load_row(image, j, k, row.data());
      const std::int64_t at = grid.index(0, j, k);
      if (by_gradient && squared) {
        detail::square_factors(gradient.data() + at, count, 1.0F / scale, factors.data());
      } else if (by_gradient) {
        for (std::int64_t i = 0; i < count; ++i) {
          const float x =
              scale > 0.0F ? std::min(gradient[at + i] / (kReach * scale), 1.0F) * 1024.0F : 0.0F;
          const auto n = static_cast<std::size_t>(x);
          factors[static_cast<std::size_t>(i)] =
              gradient_table[n] +
              (x - static_cast<float>(n)) * (gradient_table[n + 1] - gradient_table[n]);
        }
      }
      if (by_gradient) {
        detail::fuzzy_factors(by_boundary ? speed.advance.data() + at : nullptr, count, least,
                              factors.data());
      }
      float* advance = speed.advance.data() + at;
      for (std::int64_t i = 0; i < count; ++i) {
        const float a = options.method == Method::gradient
                            ? constant
                            : advection(row[static_cast<std::size_t>(i)]);
        advance[i] = factors[static_cast<std::size_t>(i)] * a;
      }
      if (factor) std::copy_n(factors.data(), count, speed.factor.data() + at);
    }
  });
  return speed;
}

}  // namespace shape3d::levelset
