#include "shape3d/levelset/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "boundary.hpp"
#include "filter_rows.hpp"
#include "message.hpp"
#include "parallel.hpp"
#include "samples.hpp"

namespace shape3d::levelset {
namespace {

using detail::text;

/// Beyond 3.1 ℓ, Y < 7e-5 counts as 0; in the sums of S(w), which look at it many times, beyond 2
/// ℓ, where it is under 0.02.
constexpr double kReach = 3.1, kOverlapReach = 2.0;

/// Nodes away from those beside the boundary that are nearer than 2 ℓ, but for a fifth of a node.
int overlap_passes(double width, const Grid& grid) {
  return std::max(
      1, static_cast<int>(std::ceil(kOverlapReach * width / grid.spacing.minCoeff() - 1.2)));
}

double width_or_default(double boundary_width, const Grid& grid) {
  detail::require(std::isfinite(boundary_width) && boundary_width >= 0.0, "boundary_width",
                  boundary_width, "a finite number of mm that is not negative");
  return boundary_width > 0.0 ? boundary_width : grid.mean_spacing();
}

/// S at one offset.
class OverlapMeter {
 public:
  OverlapMeter(const ImageView& image, const Field& gradient, const IntensityModel& model,
               const CalibrationOptions& options, int threads)
      : width_(width_or_default(options.boundary_width, image.grid())),
        distance_(image, model, kOverlapReach * width_, overlap_passes(width_, image.grid()),
                  options.max_samples, detail::BoundaryDistance::Use::many, threads),
        gradient_(gradient),
        overlap_(options.overlap),
        threads_(threads) {
    const detail::Lattice& lattice = distance_.lattice();
    std::vector<double> parts(static_cast<std::size_t>(lattice.tiles.size()), 0.0);
    detail::parallel_for(lattice.tiles.size(), threads, [&](std::int64_t t) {
      if (!distance_.wanted(t)) return;
      const detail::TileRows rows = lattice.rows(lattice.tiles[t]);
      double sum = 0.0;
      detail::for_rows(rows, detail::kAllRows, [&](std::int64_t, std::int64_t dense, int) {
        const float* row = gradient.data() + dense;
        sum += static_cast<double>(detail::add_products(row, row, rows.count).bb);
      });
      parts[static_cast<std::size_t>(t)] = sum;
    });
    for (const double part : parts) gradient_square_ += part;
  }

  double operator()(double lambda, const std::vector<double>& levels) {
    const auto limit = static_cast<float>(kOverlapReach * width_);
    const std::vector<std::int64_t>& tiles = distance_.compute(lambda, levels);
    std::vector<double> products(tiles.size()), squares(tiles.size());
    const detail::Lattice& lattice = distance_.lattice();
    detail::parallel_for(static_cast<std::int64_t>(tiles.size()), threads_, [&](std::int64_t n) {
      double product = 0.0, square = 0.0;
      const std::int64_t t = tiles[static_cast<std::size_t>(n)];
      if (!distance_.wanted(t)) return;
      const detail::TileRows rows = lattice.rows(lattice.tiles[t]);
      detail::for_rows(rows, distance_.rows(t),
                       [&](std::int64_t row, std::int64_t dense, int /*bit*/) {
                         float y[detail::kTileX];
                         std::copy_n(distance_.field().data() + row, rows.count, y);
                         detail::bell(rows.count, static_cast<float>(1.0 / width_), limit, y);
                         const detail::Products sums =
                             detail::add_products(gradient_.data() + dense, y, rows.count);
                         product += static_cast<double>(sums.ab);
                         square += static_cast<double>(sums.bb);
                       });
      products[static_cast<std::size_t>(n)] = product;
      squares[static_cast<std::size_t>(n)] = square;
    });
    double product = 0.0, square = 0.0;
    for (std::size_t n = 0; n < tiles.size(); ++n) {
      product += products[n];
      square += squares[n];
    }
    if (overlap_ == Overlap::product) return product;
    const double norm = std::sqrt(gradient_square_ * square);
    return norm > 0.0 ? product / norm : 0.0;
  }

 private:
  double width_, gradient_square_ = 0.0;
  detail::BoundaryDistance distance_;
  const Field& gradient_;
  Overlap overlap_;
  int threads_;
};

/// The offsets searched, on a scale from 0 to 1: even in intensity where the boundary has one
/// intensity, else even in λ.
class SearchScale {
 public:
  SearchScale(const IntensityModel& model, double scope) : model_(model) {
    lower_ = scope * std::min(model.min_log_odds(), 0.0);
    upper_ = scope * std::max(model.max_log_odds(), 0.0);
    if (!model.is_split()) return;
    const double first = level_near(lower_), last = level_near(upper_);
    by_intensity_ = first != last;
    if (by_intensity_) {
      lower_ = first;
      upper_ = last;
    }
  }
  struct Place {
    double lambda;
    std::vector<double> levels;
  };
  [[nodiscard]] Place at(double share) const {
    const double value = lower_ + share * (upper_ - lower_);
    if (by_intensity_) return {model_.log_odds(value), {value}};
    return {value, model_.levels(value)};
  }

 private:
  /// The level of λ, or the outer mean beyond which Λ stays on one side of it.
  [[nodiscard]] double level_near(double lambda) const {
    const std::vector<double> levels = model_.levels(lambda);
    if (!levels.empty()) return levels.front();
    const Eigen::ArrayXd& means = model_.mixture().means;
    const bool rising = model_.inside().back();
    return (lambda >= model_.max_log_odds()) == rising ? means[means.size() - 1] : means[0];
  }

  const IntensityModel& model_;
  double lower_ = 0.0, upper_ = 0.0;
  bool by_intensity_ = false;
};

struct Sample {
  double share, overlap;
  SearchScale::Place place;
};

/// Place of the maximum of the parabola through three neighbours, or the middle one.
double refine(const Sample& a, const Sample& b, const Sample& c) {
  const double left = (b.overlap - a.overlap) / (b.share - a.share);
  const double right = (c.overlap - b.overlap) / (c.share - b.share);
  const double bend = (right - left) / (c.share - a.share);
  if (!(bend < 0.0)) return b.share;
  const double place = 0.5 * (a.share + b.share) - 0.5 * left / bend;
  return std::clamp(place, a.share, c.share);
}

void check(const ImageView& image, const Field& gradient, double misfit,
           const CalibrationOptions& options) {
  using detail::require;
  validate(image);
  if (gradient.size() != image.grid().size()) {
    detail::refuse("gradient: size", text(static_cast<std::int64_t>(gradient.size())),
                   text(image.grid().size()) + ", one value a sample");
  }
  require(std::isfinite(misfit) && misfit >= 0.0, "misfit", misfit,
          "a finite number that is not negative");
  require(options.scope_constant > 0.0, "scope_constant", options.scope_constant,
          "a positive number");
  require(options.max_scope > 0.0 && options.max_scope <= 1.0, "max_scope", options.max_scope,
          "a share above 0 and up to 1");
  require(options.coarse_samples >= 3 && options.coarse_samples % 2 == 1, "coarse_samples",
          options.coarse_samples, "an odd number of at least 3");
  require(options.refinements >= 0, "refinements", options.refinements, "0 or more");
  require(options.max_samples >= 0, "max_samples", options.max_samples, "0 (all) or more");
}

}  // namespace

Calibration calibrate(const ImageView& image, const Field& gradient, const IntensityModel& model,
                      double misfit, const CalibrationOptions& options) {
  check(image, gradient, misfit, options);
  Calibration result;
  if (!model.two_sided()) return result;
  const int threads = detail::resolve_threads(options.threads);
  detail::require_finite(image, threads);
  result.scope = std::min(options.scope_constant * misfit, options.max_scope);
  const SearchScale scale(model, result.scope);
  OverlapMeter meter(image, gradient, model, options, threads);

  std::vector<Sample> samples;  // ascending in share
  const int total = options.coarse_samples + 2 * options.refinements + 1;
  int done = 0;
  const auto measure = [&](double share) {
    Sample sample{share, 0.0, scale.at(share)};
    sample.overlap = meter(sample.place.lambda, sample.place.levels);
    samples.insert(std::upper_bound(samples.begin(), samples.end(), share,
                                    [](double s, const Sample& other) { return s < other.share; }),
                   std::move(sample));
    ++done;
    result.cancelled =
        result.cancelled ||
        (options.progress && !options.progress({"calibration", static_cast<double>(done) / total}));
  };
  const auto best = [&] {
    return static_cast<std::size_t>(
        std::max_element(samples.begin(), samples.end(),
                         [](const Sample& a, const Sample& b) { return a.overlap < b.overlap; }) -
        samples.begin());
  };

  double step = 1.0 / (options.coarse_samples - 1);
  for (int n = 0; n < options.coarse_samples && !result.cancelled; ++n) measure(n * step);
  for (int pass = 0; pass < options.refinements && !result.cancelled; ++pass) {
    step *= 0.5;
    const double center = samples[best()].share;
    if (center - step >= 0.0) measure(center - step);
    if (center + step <= 1.0 && !result.cancelled) measure(center + step);
  }
  if (result.cancelled) return result;
  const std::size_t top = best();
  if (top > 0 && top + 1 < samples.size()) {
    measure(refine(samples[top - 1], samples[top], samples[top + 1]));
  }
  const SearchScale::Place& place = samples[best()].place;
  if (samples[best()].overlap > 0.0) {
    result.lambda = place.lambda;
    result.w = offset_of_log_odds(place.lambda);
    result.levels = place.levels;
  }
  for (const Sample& sample : samples) {
    const std::vector<double>& levels = sample.place.levels;
    const double w = offset_of_log_odds(sample.place.lambda);
    result.scope_w = std::max(result.scope_w, std::abs(w));
    result.curve.push_back(
        {sample.place.lambda, w,
         levels.size() == 1 ? levels.front() : std::numeric_limits<double>::quiet_NaN(),
         sample.overlap});
  }
  std::stable_sort(
      result.curve.begin(), result.curve.end(),
      [](const OverlapSample& a, const OverlapSample& b) { return a.lambda < b.lambda; });
  return result;
}

Field boundary_distance(const ImageView& image, const IntensityModel& model, double lambda,
                        double limit, int requested_threads) {
  validate(image);
  detail::require(std::isfinite(limit) && limit > 0.0, "limit", limit,
                  "a finite positive number of mm");
  const int threads = detail::resolve_threads(requested_threads);
  detail::require_finite(image, threads);
  const auto reach = static_cast<float>(limit);
  // Distance spreads by one node a pass, along the diagonal of a cell by one in three.
  const int passes = static_cast<int>(
      std::min(std::ceil(std::sqrt(3.0) * limit / image.spacing.minCoeff()), 64.0));
  detail::BoundaryDistance distance(image, model, limit, passes, 0,
                                    detail::BoundaryDistance::Use::once, threads);
  distance.compute(lambda, model.levels(lambda));
  const detail::Lattice& lattice = distance.lattice();
  Field result(lattice.grid.size());
  detail::parallel_for(lattice.tiles.size(), threads, [&](std::int64_t t) {
    const detail::TileRows rows = lattice.rows(lattice.tiles[t]);
    const detail::RowMask computed = distance.rows(t);
    detail::for_rows(rows, computed, [&](std::int64_t row, std::int64_t dense, int /*bit*/) {
      std::copy_n(distance.field().data() + row, rows.count, result.data() + dense);
    });
    detail::for_rows(rows, ~computed, [&](std::int64_t row, std::int64_t dense, int /*bit*/) {
      std::fill_n(result.data() + dense, rows.count, distance.side(row) * reach);
    });
  });
  return result;
}

Field boundary_detector(const ImageView& image, const IntensityModel& model, double lambda,
                        double boundary_width, int threads) {
  detail::require(std::isfinite(boundary_width) && boundary_width > 0.0, "boundary_width",
                  boundary_width, "a finite positive number of mm");
  const double limit = kReach * boundary_width;
  Field field = boundary_distance(image, model, lambda, limit, threads);
  detail::bell(field.size(), static_cast<float>(1.0 / boundary_width), static_cast<float>(limit),
               field.data());
  return field;
}

}  // namespace shape3d::levelset
