#include "label_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "distance_transform.hpp"
#include "text.hpp"

namespace shape3d::apps {
namespace {

using Index3 = std::array<std::int64_t, 3>;

std::size_t at(const Mask& mask, const Index3& p) {
  return static_cast<std::size_t>(mask.index(p));
}

void require_within(const Mask& mask, const Index3& seed) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (seed[axis] < 0 || seed[axis] >= mask.dims[axis]) {
      throw std::invalid_argument("seed[" + std::to_string(axis) + "] is " +
                                  std::to_string(seed[axis]) + "; expected 0 to " +
                                  std::to_string(mask.dims[axis] - 1));
    }
  }
}

// Moves the component of a sample from `rest` to `component`.
void take_component(const Mask& mask, std::size_t seed, std::vector<std::uint8_t>& rest,
                    std::vector<std::uint8_t>* component) {
  const std::int64_t nx = mask.dims[0], plane = nx * mask.dims[1];
  const auto size = static_cast<std::int64_t>(rest.size());
  std::vector<std::int64_t> open{static_cast<std::int64_t>(seed)};
  rest[seed] = 0;
  while (!open.empty()) {
    const std::int64_t n = open.back();
    open.pop_back();
    if (component != nullptr) (*component)[static_cast<std::size_t>(n)] = 1;
    const std::int64_t i = n % nx, j = n / nx % mask.dims[1];
    const auto visit = [&](std::int64_t m, bool inside) {
      if (!inside || rest[static_cast<std::size_t>(m)] == 0) return;
      rest[static_cast<std::size_t>(m)] = 0;
      open.push_back(m);
    };
    visit(n - 1, i > 0);
    visit(n + 1, i + 1 < nx);
    visit(n - nx, j > 0);
    visit(n + nx, j + 1 < mask.dims[1]);
    visit(n - plane, n >= plane);
    visit(n + plane, n + plane < size);
  }
}

Mask like(const Mask& mask) {
  Mask result;
  result.dims = mask.dims;
  result.spacing = mask.spacing;
  result.samples.assign(mask.samples.size(), 0);
  return result;
}

// Squared distance of each sample to the nearest outside the mask; infinity when there is none.
std::vector<float> depths(const Mask& mask) {
  std::vector<std::uint8_t> outside(mask.samples.size());
  std::transform(mask.samples.begin(), mask.samples.end(), outside.begin(),
                 [](std::uint8_t value) { return value == 0 ? std::uint8_t{1} : std::uint8_t{0}; });
  return squared_distances(outside, mask.dims, mask.spacing);
}

// A ball of the radius round a sample lies in the mask when no sample outside is within the radius.
// Rounding to float must not decide at equal distances: 1e-6 relative is 8 of its steps.
float squared_limit(double radius) { return static_cast<float>(radius * radius * (1.0 + 1e-6)); }

Mask open_with_depths(const Mask& mask, const std::vector<float>& squares, double radius) {
  const float limit = squared_limit(radius);
  Mask result = like(mask);
  for (std::size_t n = 0; n < squares.size(); ++n)
    result.samples[n] = mask.samples[n] != 0 && squares[n] > limit ? 1 : 0;
  const std::vector<float> from_centres =
      squared_distances(result.samples, mask.dims, mask.spacing);
  for (std::size_t n = 0; n < squares.size(); ++n)
    result.samples[n] = mask.samples[n] != 0 && from_centres[n] <= limit ? 1 : 0;
  return result;
}

}  // namespace

std::int64_t count_components(const Mask& mask) {
  std::vector<std::uint8_t> rest = mask.samples;
  std::int64_t count = 0;
  for (std::size_t n = 0; n < rest.size(); ++n) {
    if (rest[n] == 0) continue;
    take_component(mask, n, rest, nullptr);
    ++count;
  }
  return count;
}

Mask component_at(const Mask& mask, const Index3& seed) {
  require_within(mask, seed);
  Mask result = like(mask);
  std::vector<std::uint8_t> rest = mask.samples;
  if (rest[at(mask, seed)] != 0) take_component(mask, at(mask, seed), rest, &result.samples);
  return result;
}

std::optional<Index3> nearest_inside(const Mask& mask, const Eigen::Vector3d& place, double reach) {
  std::optional<Index3> best;
  double least = reach * reach;
  for (std::int64_t k = 0; k < mask.dims[2]; ++k) {
    for (std::int64_t j = 0; j < mask.dims[1]; ++j) {
      for (std::int64_t i = 0; i < mask.dims[0]; ++i) {
        if (mask.samples[at(mask, {i, j, k})] == 0) continue;
        const Eigen::Vector3d p(static_cast<double>(i), static_cast<double>(j),
                                static_cast<double>(k));
        const double squared = (p - place).cwiseProduct(mask.spacing).squaredNorm();
        if (squared > least || (best && squared == least)) continue;
        least = squared;
        best = Index3{i, j, k};
      }
    }
  }
  return best;
}

Mask open_by_ball(const Mask& mask, double radius) {
  if (!(radius >= 0.0) || !std::isfinite(radius)) {
    throw std::invalid_argument("radius is " + to_text(radius) +
                                "; expected a finite number, 0 or more");
  }
  return open_with_depths(mask, depths(mask), radius);
}

}  // namespace shape3d::apps
