#include "support/lung_phantom.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <stdexcept>

#include "support/lung_anatomy.hpp"
#include "support/random_numbers.hpp"

namespace shape3d::test {
namespace {

constexpr double kBlur = 0.9;  // samples

// Which of the 27 points of each cell a set of shapes covers.
class Coverage {
 public:
  explicit Coverage(const std::array<std::int64_t, 3>& dims)
      : dims_(dims), bits_(static_cast<std::size_t>(dims[0] * dims[1] * dims[2]), 0) {}

  /// Adds the points of a box of samples where inside(p) holds; p in samples. In cells whose
  /// middle is deeper than a cell reaches, |depth(p)| ≥ 1 sample, all points are alike.
  template <class Depth>
  void add(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Depth& depth) {
    std::array<std::int64_t, 3> lower{}, upper{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<Eigen::Index>(axis);
      lower[axis] = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::floor(low[a])) - 1);
      upper[axis] = std::min(dims_[axis], static_cast<std::int64_t>(std::ceil(high[a])) + 2);
    }
    for (std::int64_t k = lower[2]; k < upper[2]; ++k) {
      for (std::int64_t j = lower[1]; j < upper[1]; ++j) {
        std::uint32_t* row = bits_.data() + (k * dims_[1] + j) * dims_[0];
        for (std::int64_t i = lower[0]; i < upper[0]; ++i) {
          const Eigen::Vector3d p(static_cast<double>(i), static_cast<double>(j),
                                  static_cast<double>(k));
          const double middle = depth(p);
          if (middle >= 1.0) row[i] = kAll;
          if (std::abs(middle) < 1.0) row[i] |= points_inside(p, depth);
        }
      }
    }
  }

  [[nodiscard]] std::uint32_t operator[](std::size_t n) const { return bits_[n]; }
  [[nodiscard]] std::size_t size() const { return bits_.size(); }

  static int count(std::uint32_t bits) { return static_cast<int>(std::bitset<32>(bits).count()); }

 private:
  static constexpr std::uint32_t kAll = (1U << 27) - 1;

  template <class Depth>
  static std::uint32_t points_inside(const Eigen::Vector3d& p, const Depth& depth) {
    std::uint32_t bits = 0;
    for (int n = 0; n < 27; ++n) {
      const Eigen::Vector3d offset(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      if (depth(p + offset / 3.0) > 0.0) bits |= 1U << n;
    }
    return bits;
  }

  std::array<std::int64_t, 3> dims_;
  std::vector<std::uint32_t> bits_;
};

void add_ball(Coverage& coverage, const Eigen::Vector3d& centre, double radius) {
  coverage.add(centre.array() - radius, centre.array() + radius,
               [&](const Eigen::Vector3d& p) { return radius - (p - centre).norm(); });
}

void add_tube(Coverage& coverage, const VesselSegment& tube) {
  const Eigen::Vector3d axis = tube.end - tube.start;
  const double squared = axis.squaredNorm();
  const double radius = std::max(tube.start_radius, tube.end_radius);
  coverage.add(tube.start.cwiseMin(tube.end).array() - radius,
               tube.start.cwiseMax(tube.end).array() + radius, [&](const Eigen::Vector3d& p) {
                 const double t = std::clamp((p - tube.start).dot(axis) / squared, 0.0, 1.0);
                 const double r = tube.start_radius + t * (tube.end_radius - tube.start_radius);
                 return r - (p - tube.start - t * axis).norm();
               });
}

// Convolution with a Gaussian along one axis; the border sample continues outside.
void blur(std::vector<float>& values, const std::array<std::int64_t, 3>& dims, std::size_t axis) {
  constexpr int kReach = 4;
  std::array<float, 2 * kReach + 1> weights{};
  double sum = 0.0;
  for (int n = -kReach; n <= kReach; ++n) sum += std::exp(-0.5 * n * n / (kBlur * kBlur));
  for (int n = -kReach; n <= kReach; ++n) {
    weights[static_cast<std::size_t>(n + kReach)] =
        static_cast<float>(std::exp(-0.5 * n * n / (kBlur * kBlur)) / sum);
  }
  const std::array<std::int64_t, 3> strides{1, dims[0], dims[0] * dims[1]};
  const std::size_t across = axis == 0 ? 1 : 0, above = axis == 2 ? 1 : 2;
  const std::int64_t length = dims[axis];
  std::vector<float> row(static_cast<std::size_t>(length));
  for (std::int64_t k = 0; k < dims[above]; ++k) {
    for (std::int64_t j = 0; j < dims[across]; ++j) {
      float* at = values.data() + k * strides[above] + j * strides[across];
      for (std::int64_t i = 0; i < length; ++i)
        row[static_cast<std::size_t>(i)] = at[i * strides[axis]];
      for (std::int64_t i = 0; i < length; ++i) {
        float total = 0.0F;
        for (int n = -kReach; n <= kReach; ++n) {
          total += weights[static_cast<std::size_t>(n + kReach)] *
                   row[static_cast<std::size_t>(std::clamp<std::int64_t>(i + n, 0, length - 1))];
        }
        at[i * strides[axis]] = total;
      }
    }
  }
}

double noisy(double value, const LungPhantomOptions& options, RandomNumbers& random) {
  const double s = options.noise_hu;
  if (s == 0.0) return value;
  switch (options.noise) {
    case PhantomNoise::gaussian:
      return value + s * random.normal();
    case PhantomNoise::poisson: {
      const double gain = s * s / (LungPhantom::kHalfLevel + 1024.0);
      return gain * static_cast<double>(random.poisson((value + 1024.0) / gain)) - 1024.0;
    }
    case PhantomNoise::rayleigh: {
      // Of scale c: mean c √(π/2), variance c² (4 − π)/2.
      const double scale = s / std::sqrt((4.0 - kPi) / 2.0);
      return value + random.rayleigh(scale) - scale * std::sqrt(kPi / 2.0);
    }
  }
  return value;
}

void validate(const LungPhantomOptions& options) {
  for (const std::int64_t size : options.dims) {
    if (size < 24)
      throw std::invalid_argument("dims has " + std::to_string(size) + "; expected 24 or more");
  }
  if (!(options.noise_hu >= 0.0) || !std::isfinite(options.noise_hu)) {
    throw std::invalid_argument("noise_hu is " + std::to_string(options.noise_hu) +
                                "; expected a finite number, 0 or more");
  }
}

}  // namespace

std::string to_string(PhantomNoise noise) {
  switch (noise) {
    case PhantomNoise::gaussian:
      return "Gaussian";
    case PhantomNoise::poisson:
      return "Poisson";
    case PhantomNoise::rayleigh:
      return "Rayleigh";
  }
  return {};
}

std::string to_string(NoduleKind kind) {
  switch (kind) {
    case NoduleKind::isolated:
      return "isolated";
    case NoduleKind::on_vessel:
      return "on a vessel";
    case NoduleKind::at_pleura:
      return "at the pleura";
    case NoduleKind::ground_glass:
      return "ground glass";
  }
  return {};
}

std::vector<std::uint8_t> LungPhantom::tissue() const {
  std::vector<std::uint8_t> solid(256, 1);
  solid[kLung] = 0;
  for (const PhantomNodule& nodule : nodules) {
    if (nodule.kind == NoduleKind::ground_glass) solid[nodule.label] = 0;
  }
  std::vector<std::uint8_t> mask(labels.size());
  for (std::size_t n = 0; n < labels.size(); ++n) mask[n] = solid[labels[n]];
  return mask;
}

std::vector<std::uint8_t> LungPhantom::nodule(const PhantomNodule& nodule) const {
  std::vector<std::uint8_t> mask(labels.size());
  for (std::size_t n = 0; n < labels.size(); ++n) mask[n] = labels[n] == nodule.label ? 1 : 0;
  return mask;
}

LungPhantom make_lung_phantom(const LungPhantomOptions& options) {
  validate(options);
  RandomNumbers random(options.seed);
  const LungAnatomy anatomy(options.dims, random);
  LungPhantom phantom;
  phantom.dims = options.dims;
  phantom.spacing = options.spacing;
  const Eigen::Vector3d last(static_cast<double>(options.dims[0] - 1),
                             static_cast<double>(options.dims[1] - 1),
                             static_cast<double>(options.dims[2] - 1));
  Coverage wall(options.dims), vessels(options.dims), solid(options.dims), glass(options.dims);
  wall.add(Eigen::Vector3d::Zero(), last,
           [&](const Eigen::Vector3d& p) { return -anatomy.depth_in_lung(p); });
  for (const VesselSegment& tube : anatomy.vessels()) add_tube(vessels, tube);
  phantom.labels.assign(wall.size(), LungPhantom::kLung);
  std::vector<float> values(wall.size());
  for (const AnatomicNodule& ball : anatomy.nodules()) {
    PhantomNodule nodule;
    nodule.kind = ball.kind;
    nodule.label = static_cast<std::uint8_t>(LungPhantom::kFirstNodule + phantom.nodules.size());
    nodule.centre = ball.centre;
    nodule.radius = ball.radius * options.spacing.x();
    add_ball(ball.kind == NoduleKind::ground_glass ? glass : solid, ball.centre, ball.radius);
    phantom.nodules.push_back(nodule);
  }
  const auto nearest_nodule = [&](std::size_t n) {
    const auto x = static_cast<double>(n % static_cast<std::size_t>(options.dims[0]));
    const auto y = static_cast<double>(n / static_cast<std::size_t>(options.dims[0]) %
                                       static_cast<std::size_t>(options.dims[1]));
    const auto z =
        static_cast<double>(n / static_cast<std::size_t>(options.dims[0] * options.dims[1]));
    const auto distance = [&](const PhantomNodule& nodule) {
      return (nodule.centre - Eigen::Vector3d(x, y, z)).norm();
    };
    return std::min_element(phantom.nodules.begin(), phantom.nodules.end(),
                            [&](const PhantomNodule& a, const PhantomNodule& b) {
                              return distance(a) < distance(b);
                            })
        ->label;
  };
  for (std::size_t n = 0; n < wall.size(); ++n) {
    const std::uint32_t tissue = wall[n] | vessels[n] | solid[n];
    const std::uint32_t ground = glass[n] & ~tissue;
    const double of_tissue = Coverage::count(tissue) / 27.0;
    const double of_glass = Coverage::count(ground) / 27.0;
    values[n] = static_cast<float>(LungPhantom::kAir +
                                   of_tissue * (LungPhantom::kTissue - LungPhantom::kAir) +
                                   of_glass * (LungPhantom::kGroundGlass - LungPhantom::kAir));
    constexpr int kMost = 14;  // of 27
    if (Coverage::count(wall[n]) >= kMost) {
      phantom.labels[n] = LungPhantom::kWall;
    } else if (Coverage::count(solid[n] & ~wall[n]) >= kMost || Coverage::count(ground) >= kMost) {
      phantom.labels[n] = nearest_nodule(n);
    } else if (Coverage::count(tissue) >= kMost) {
      phantom.labels[n] = LungPhantom::kVessel;  // or parts of several
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) blur(values, options.dims, axis);
  phantom.samples.resize(values.size());
  for (std::size_t n = 0; n < values.size(); ++n) {
    const double value = noisy(static_cast<double>(values[n]), options, random);
    phantom.samples[n] = static_cast<std::int16_t>(std::lround(std::clamp(value, -1024.0, 3071.0)));
  }
  return phantom;
}

}  // namespace shape3d::test
