#include "shape3d/levelset/segment.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include "message.hpp"
#include "parallel.hpp"

namespace shape3d::levelset {
namespace {

using Clock = std::chrono::steady_clock;

/// Adds the time of its life to a sum.
class Timer {
 public:
  explicit Timer(double& sum) : sum_(sum), start_(Clock::now()) {}
  ~Timer() { sum_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

 private:
  double& sum_;
  Clock::time_point start_;
};

/// Mean intensity of each run of neighbouring classes on one side: of the air and of the tissue.
std::vector<double> side_means(const IntensityModel& model) {
  const GaussianMixture& mixture = model.mixture();
  std::vector<double> means;
  double weight = 0.0, sum = 0.0;
  for (int k = 0; k < mixture.size(); ++k) {
    const auto n = static_cast<std::size_t>(k);
    weight += mixture.weights[k];
    sum += mixture.weights[k] * mixture.means[k];
    if (k + 1 < mixture.size() && model.inside()[n] == model.inside()[n + 1]) continue;
    if (weight > 0.0) means.push_back(sum / weight);
    weight = sum = 0.0;
  }
  return means;
}

constexpr double kDeviations = 3.0;  // of the noise, from either side to the boundary
constexpr double kLeastSmoothing = 0.3, kWidestSmoothing = 1.5;  // voxels

/// The least smoothing after which the half way between the sides is three deviations of the noise
/// away from each: one sample in 740 is then on the wrong side.
double automatic_smoothing(double noise, const IntensityModel& model,
                           const std::array<std::int64_t, 3>& dims) {
  const std::vector<double> means = side_means(model);
  double distance = std::numeric_limits<double>::infinity();
  for (std::size_t n = 1; n < means.size(); ++n)
    distance = std::min(distance, means[n] - means[n - 1]);
  const double wanted = distance / (2.0 * kDeviations * noise);
  if (!(wanted < 1.0)) return 0.0;
  const auto axes = std::count_if(dims.begin(), dims.end(), [](std::int64_t n) { return n > 1; });
  double low = kLeastSmoothing, high = kWidestSmoothing;
  for (int step = 0; step < 12; ++step) {
    const double sigma = 0.5 * (low + high);
    (std::pow(noise_gain(sigma), axes) > wanted ? low : high) = sigma;
  }
  return high;
}

/// The stages, one after the other, on one result.
class Pipeline {
 public:
  Pipeline(const ImageView& image, const SegmentOptions& options, const Field& start)
      : image_(image), options_(options), start_(start) {
    options_.histogram.threads = options.threads;
    options_.calibration.threads = options.threads;
    options_.speed.threads = options.threads;
    options_.evolution.threads = options.threads;
    options_.calibration.progress = options.progress;
    options_.evolution.progress = options.progress;
  }

  Segmentation run() {
    warn();
    if (estimate() && smooth_intensities() && calibrate_model()) move_front();
    return std::move(result_);
  }

 private:
  bool report(const char* stage, double share) {
    if (!options_.progress || options_.progress(Progress{stage, share})) return true;
    return end(Status::cancelled);
  }
  bool end(Status status) {
    result_.status = status;
    return false;
  }

  void warn() {
    const double ratio = anisotropy(image_.spacing);
    if (ratio > 20.0) {
      std::ostringstream text;
      text << "the spacing (" << image_.spacing[0] << ", " << image_.spacing[1] << ", "
           << image_.spacing[2] << ") mm is anisotropic by " << ratio
           << " : 1; above 20 : 1 the front is hardly resolved along the wide axis";
      result_.warnings.push_back(text.str());
    }
  }

  /// Histogram, mixture, classes.
  bool estimate() {
    {
      const Timer timer(result_.timings.histogram);
      result_.histogram = histogram(image_, options_.histogram);
    }
    if (!report("histogram", 1.0)) return false;
    if (!(result_.histogram.minimum < result_.histogram.maximum))
      return end(Status::constant_image);
    const Timer timer(result_.timings.mixture);
    if (options_.known_mixture.size() > 0) {
      result_.fit.mixture = options_.known_mixture;
      result_.fit.stop = MixtureStop::given;
      result_.fit.misfit = misfit(result_.histogram, result_.fit.mixture);
    } else {
      result_.fit = fit_mixture(result_.histogram, options_.mixture);
    }
    if (result_.fit.stop == MixtureStop::too_few_bins) return end(Status::too_few_bins);
    result_.model = make_intensity_model(result_.fit.mixture, options_.inside);
    if (!result_.model.two_sided()) return end(Status::one_sided);
    return report("mixture", 1.0);
  }

  /// When there is much noise: smooths, and estimates again from the smoothed intensities.
  bool smooth_intensities() {
    {
      const Timer timer(result_.timings.smoothing);
      result_.noise = noise_deviation(image_, options_.threads);
      result_.smoothing = options_.smoothing >= 0.0
                              ? options_.smoothing
                              : automatic_smoothing(result_.noise, result_.model, image_.dims);
      if (result_.smoothing < kLeastSmoothing) {
        result_.smoothing = 0.0;
        return true;
      }
      smoothed_ = smooth_by_voxels(result_.smoothing);
      image_ = make_view(smoothed_.data(), image_.dims, image_.spacing);
    }
    return report("smoothing", 1.0) && estimate();
  }

  /// σ in voxels of each axis: the axes are smoothed as if their spacing were 1.
  Field smooth_by_voxels(double sigma) const {
    ImageView unit = image_;
    unit.spacing.setOnes();
    return smooth(unit, sigma, options_.threads);
  }

  bool needs_gradient() const { return options_.speed.method != Method::intensity; }

  bool calibrate_model() {
    if (!needs_gradient()) return true;
    {
      const Timer timer(result_.timings.gradient);
      gradient_ = gradient_magnitude(image_, options_.sigma, options_.threads);
    }
    if (!report("gradient", 1.0)) return false;
    if (options_.speed.method != Method::combined || !options_.calibrated) return true;
    const Timer timer(result_.timings.calibration);
    result_.calibration =
        calibrate(image_, gradient_, result_.model, result_.fit.misfit, options_.calibration);
    return !result_.calibration.cancelled || end(Status::cancelled);
  }

  void move_front() {
    Speed speed;
    {
      const Timer timer(result_.timings.speed);
      speed = make_speed(image_, gradient_, result_.model, result_.calibration.lambda,
                         options_.evolution.curvature > 0.0, options_.speed);
      gradient_.resize(0);
      smoothed_.resize(0);
      result_.gradient_scale = speed.gradient_scale;
    }
    if (!report("speed", 1.0)) return;
    const Timer timer(result_.timings.evolution);
    const Grid grid = image_.grid();
    if (start_.size() > 0) {
      result_.evolution = evolve(grid, start_, speed.advance, speed.factor, options_.evolution);
    } else {
      options_.evolution.border = Border::outside;
      result_.evolution = evolve(grid, box_front(grid, {{0, 0, 0}, grid.dims}), speed.advance,
                                 speed.factor, options_.evolution);
    }
    result_.status = result_.evolution.status;
    result_.inside = (result_.evolution.psi <= 0.0F).count();
    result_.volume = static_cast<double>(result_.inside) * grid.spacing.prod();
  }

  ImageView image_;
  SegmentOptions options_;
  const Field& start_;
  Field smoothed_, gradient_;
  Segmentation result_;
};

}  // namespace

Eigen::Array<std::uint8_t, -1, 1> Segmentation::labels() const {
  return (evolution.psi <= 0.0F).cast<std::uint8_t>();
}

Segmentation segment(const ImageView& image, const SegmentOptions& options, const Field& start) {
  validate(image);
  detail::resolve_threads(options.threads);
  if (start.size() > 0 && start.size() != image.grid().size()) {
    detail::refuse("start: size", detail::text(static_cast<std::int64_t>(start.size())),
                   detail::text(image.grid().size()) + ", one value a sample");
  }
  detail::require(!(options.smoothing > 16.0), "smoothing", options.smoothing,
                  "at most 16 voxels, or a negative number (automatic)");
  return Pipeline(image, options, start).run();
}

}  // namespace shape3d::levelset
