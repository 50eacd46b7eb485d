#include "nodule.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "distance_transform.hpp"
#include "text.hpp"

namespace shape3d::apps {
namespace {

using Index3 = std::array<std::int64_t, 3>;

std::size_t at(const Mask& mask, const Index3& p) {
  return static_cast<std::size_t>(mask.index(p));
}

Mask like(const Mask& mask) {
  return {std::vector<std::uint8_t>(mask.samples.size(), 0), mask.dims, mask.spacing};
}

// Calls visit(p, n) for each sample, x fastest.
template <class Visit>
void for_each_sample(const Mask& mask, const Visit& visit) {
  std::size_t n = 0;
  for (std::int64_t k = 0; k < mask.dims[2]; ++k) {
    for (std::int64_t j = 0; j < mask.dims[1]; ++j) {
      for (std::int64_t i = 0; i < mask.dims[0]; ++i, ++n) visit(Index3{i, j, k}, n);
    }
  }
}

double distance(const Mask& mask, const Index3& p, const Index3& q) {
  const Eigen::Vector3d step(static_cast<double>(p[0] - q[0]), static_cast<double>(p[1] - q[1]),
                             static_cast<double>(p[2] - q[2]));
  return step.cwiseProduct(mask.spacing).norm();
}

// Opening by a ball of a mask that goes on beyond its lattice as it is at the border.
Mask open_continued(const Mask& mask, double radius) {
  Mask wide;
  wide.spacing = mask.spacing;
  Index3 margin{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double h = mask.spacing[static_cast<Eigen::Index>(axis)];
    margin[axis] = static_cast<std::int64_t>(std::ceil(radius / h)) + 1;
    wide.dims[axis] = mask.dims[axis] + 2 * margin[axis];
  }
  wide.samples.resize(static_cast<std::size_t>(wide.dims[0] * wide.dims[1] * wide.dims[2]));
  for_each_sample(wide, [&](const Index3& p, std::size_t n) {
    Index3 q{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      q[axis] = std::clamp<std::int64_t>(p[axis] - margin[axis], 0, mask.dims[axis] - 1);
    wide.samples[n] = mask.samples[at(mask, q)];
  });
  const Mask opened = open_by_ball(wide, radius);
  Mask result = like(mask);
  for_each_sample(mask, [&](const Index3& p, std::size_t n) {
    result.samples[n] =
        opened.samples[at(wide, {p[0] + margin[0], p[1] + margin[1], p[2] + margin[2]})];
  });
  return result;
}

// The samples of `rest` that are beside one of the mask by a face, and the mask.
void grow_by_a_layer(Mask& mask, const Mask& rest) {
  const Mask before = mask;
  for_each_sample(mask, [&](const Index3& p, std::size_t n) {
    if (rest.samples[n] == 0) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const std::int64_t step : {-1, 1}) {
        Index3 q = p;
        q[axis] += step;
        if (q[axis] < 0 || q[axis] >= mask.dims[axis]) continue;
        if (before.samples[at(mask, q)] != 0) mask.samples[n] = 1;
      }
    }
  });
}

void validate(const NoduleOptions& options) {
  if (!(options.vessel_share >= 0.0 && options.vessel_share < 1.0)) {
    throw std::invalid_argument("vessel_share is " + to_text(options.vessel_share) +
                                "; expected 0 or more, below 1");
  }
  if (!(options.wall_share > 1.0)) {
    throw std::invalid_argument("wall_share is " + to_text(options.wall_share) +
                                "; expected more than 1");
  }
  if (!(options.radius >= 0.0) || !std::isfinite(options.radius)) {
    throw std::invalid_argument("radius is " + to_text(options.radius) +
                                "; expected a finite number of mm, 0 or more");
  }
}

class Cutting {
 public:
  Cutting(const Mask& mask, const Index3& seed, const NoduleOptions& options)
      : mask_(mask), seed_(seed), options_(options), depths_(depths()) {
    nodule_.mask = like(mask);
  }

  Nodule run() {
    if (!find_middle()) return std::move(nodule_);
    nodule_.vessel_radius = options_.vessel_share * nodule_.inscribed_radius;
    Mask cores = like(mask_);
    // The depth is that in the whole mask: the cut through the wall does not round the nodule.
    for (std::size_t n = 0; n < depths_.size(); ++n)
      cores.samples[n] = rest_.samples[n] != 0 && depths_[n] > nodule_.vessel_radius ? 1 : 0;
    const Mask core = component_at(cores, middle_);
    const std::vector<float> squares = squared_distances(core.samples, mask_.dims, mask_.spacing);
    const double limit = nodule_.vessel_radius * nodule_.vessel_radius * (1.0 + 1e-6);
    for (std::size_t n = 0; n < squares.size(); ++n) {
      nodule_.mask.samples[n] =
          rest_.samples[n] != 0 && static_cast<double>(squares[n]) <= limit ? 1 : 0;
    }
    grow_by_a_layer(nodule_.mask, rest_);
    return std::move(nodule_);
  }

 private:
  // Distance to the nearest sample outside the mask.
  [[nodiscard]] std::vector<double> depths() const {
    std::vector<std::uint8_t> outside(mask_.samples.size());
    for (std::size_t n = 0; n < outside.size(); ++n) outside[n] = mask_.samples[n] == 0 ? 1 : 0;
    const std::vector<float> squares = squared_distances(outside, mask_.dims, mask_.spacing);
    std::vector<double> result(squares.size());
    for (std::size_t n = 0; n < squares.size(); ++n) {
      result[n] = std::sqrt(static_cast<double>(squares[n]));
      if (options_.radius > 0.0) result[n] = std::min(result[n], options_.radius);
    }
    return result;
  }

  // The mask without what holds the large ball, and without what is too far.
  void cut_wall() {
    nodule_.wall_radius = options_.wall_share * nodule_.inscribed_radius;
    const Mask wall = open_continued(mask_, nodule_.wall_radius);
    rest_ = mask_;
    for_each_sample(mask_, [&](const Index3& p, std::size_t n) {
      const bool far = options_.radius > 0.0 && distance(mask_, p, seed_) > 2.0 * options_.radius;
      if (wall.samples[n] != 0 || far) rest_.samples[n] = 0;
    });
  }

  // The wall is cut by the ball at the seed; what is deeper near it gives a larger ball, by which
  // the wall is cut anew. Nothing when the seed is in the wall.
  bool find_middle() {
    middle_ = seed_;
    nodule_.inscribed_radius = depths_[at(mask_, seed_)];
    if (!std::isfinite(nodule_.inscribed_radius)) {  // the mask fills the lattice
      nodule_.mask = mask_;
      return false;
    }
    constexpr int kRounds = 4;
    for (int round = 0; round < kRounds; ++round) {
      cut_wall();
      const double reach = 0.5 * nodule_.inscribed_radius;
      double deepest = 0.0;
      for_each_sample(mask_, [&](const Index3& p, std::size_t n) {
        if (rest_.samples[n] == 0 || depths_[n] <= deepest || distance(mask_, p, seed_) > reach)
          return;
        deepest = depths_[n];
        middle_ = p;
      });
      if (deepest == 0.0) return false;
      if (deepest <= nodule_.inscribed_radius) return true;
      nodule_.inscribed_radius = deepest;
    }
    cut_wall();
    return rest_.samples[at(mask_, middle_)] != 0;
  }

  const Mask& mask_;
  Index3 seed_, middle_{};
  NoduleOptions options_;
  std::vector<double> depths_;
  Mask rest_;
  Nodule nodule_;
};

}  // namespace

Nodule nodule_at(const Mask& mask, const Index3& seed, const NoduleOptions& options) {
  validate(options);
  const Mask component = component_at(mask, seed);  // refuses a seed outside the lattice
  if (component.samples[at(mask, seed)] == 0) {
    Nodule none;
    none.mask = component;
    return none;
  }
  return Cutting(mask, seed, options).run();
}

}  // namespace shape3d::apps
