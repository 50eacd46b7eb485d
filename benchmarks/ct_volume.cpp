#include "ct_volume.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace shape3d::bench {
namespace {

constexpr double kMean = 900.0;
constexpr double kSlope =
    15.0;  // s / w: standard deviation of the coarsest octave by its wavelength
constexpr double kAir = -3000.0;

/// Variance of the spline is a third of (151/315)³ on average: its values are scaled by 1 / σ.
constexpr double kNormalise = 5.22;

std::uint64_t mixed(std::uint64_t x) {  // SplitMix64 (Steele, Lea, Flood 2014)
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// The four values of a cubic B-spline at a lattice coordinate, and the first that it weighs.
struct Knot {
  std::size_t first;
  std::array<double, 4> weights;
};

std::vector<Knot> knots(std::int64_t samples, double wavelength) {
  std::vector<Knot> result;
  result.reserve(static_cast<std::size_t>(samples));
  for (std::int64_t i = 0; i < samples; ++i) {
    const double place = static_cast<double>(i) / wavelength;
    const double whole = std::floor(place), t = place - whole, u = 1 - t;
    result.push_back({static_cast<std::size_t>(whole),
                      {u * u * u / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
                       (3 * u * u * u - 6 * u * u + 4) / 6, t * t * t / 6}});
  }
  return result;
}

/// Cubic B-spline over random lattice values. Planes and rows are asked for in ascending order.
class Octave {
 public:
  Octave(const std::array<std::int64_t, 3>& dims, double wavelength, double amplitude,
         std::uint64_t seed)
      : x_(knots(dims[0], wavelength)),
        y_(knots(dims[1], wavelength)),
        z_(knots(dims[2], wavelength / 2)),
        nx_(x_.back().first + 4),
        ny_(y_.back().first + 4) {
    for (std::uint64_t z = 0; z < z_.back().first + 4; ++z) {
      for (std::uint64_t y = 0; y < ny_; ++y) {
        for (std::uint64_t x = 0; x < nx_; ++x) {
          const std::uint64_t bits = mixed(mixed(mixed(mixed(seed) + z) + y) + x);
          values_.push_back(amplitude * kNormalise *
                            (static_cast<double>(bits >> 11) * 0x1p-52 - 1));
        }
      }
    }
    plane_.resize(nx_ * ny_);
    row_.resize(nx_);
  }

  void go_to_plane(std::int64_t z) {
    const Knot& knot = z_[static_cast<std::size_t>(z)];
    const double* v = values_.data() + knot.first * plane_.size();
    for (std::size_t i = 0; i < plane_.size(); ++i) {
      plane_[i] = weighted(knot, v + i, plane_.size());
    }
  }

  void go_to_row(std::int64_t y) {
    const Knot& knot = y_[static_cast<std::size_t>(y)];
    const double* v = plane_.data() + knot.first * nx_;
    for (std::size_t i = 0; i < nx_; ++i) row_[i] = weighted(knot, v + i, nx_);
  }

  void add_row(std::vector<double>& sums) const {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      sums[i] += weighted(x_[i], row_.data() + x_[i].first, 1);
    }
  }

 private:
  static double weighted(const Knot& knot, const double* v, std::size_t stride) {
    return knot.weights[0] * v[0] + knot.weights[1] * v[stride] + knot.weights[2] * v[2 * stride] +
           knot.weights[3] * v[3 * stride];
  }

  std::vector<Knot> x_, y_, z_;
  std::size_t nx_, ny_;
  std::vector<double> values_, plane_, row_;
};

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// −1 … 1 along an axis of the lattice.
double centred(std::int64_t i, std::int64_t samples) {
  return 2 * static_cast<double>(i) / static_cast<double>(samples - 1) - 1;
}

}  // namespace

std::vector<std::int16_t> make_ct_volume(const std::array<std::int64_t, 3>& dims, double wavelength,
                                         std::uint64_t seed) {
  std::vector<Octave> octaves;
  double amplitude = kSlope * wavelength;
  for (int o = 0; o < 4; ++o) {
    octaves.emplace_back(dims, wavelength / (1 << o), amplitude / (1 << o),
                         seed * 4 + static_cast<std::uint64_t>(o));
  }
  std::vector<std::int16_t> samples;
  samples.reserve(static_cast<std::size_t>(dims[0] * dims[1] * dims[2]));
  std::vector<double> sums(static_cast<std::size_t>(dims[0]));
  for (std::int64_t z = 0; z < dims[2]; ++z) {
    for (Octave& octave : octaves) octave.go_to_plane(z);
    for (std::int64_t y = 0; y < dims[1]; ++y) {
      std::fill(sums.begin(), sums.end(), kMean);
      for (Octave& octave : octaves) {
        octave.go_to_row(y);
        octave.add_row(sums);
      }
      const double v = centred(y, dims[1]);
      for (std::int64_t x = 0; x < dims[0]; ++x) {
        const double u = centred(x, dims[0]);
        const double value = sums[static_cast<std::size_t>(x)] +
                             kAir * smooth_step(0.85, 1.0, std::sqrt(u * u + v * v));
        samples.push_back(
            static_cast<std::int16_t>(std::floor(std::clamp(value, -1024.0, 3071.0) + 0.5)));
      }
    }
  }
  return samples;
}

}  // namespace shape3d::bench
