#include "common/segmentation_measures.hpp"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "common/distance_transform.hpp"
#include "common/label_map.hpp"
#include "common/nodule.hpp"
#include "support/random_numbers.hpp"

namespace {
using namespace shape3d::apps;
using Catch::Matchers::Message;
using shape3d::test::kPi;
using shape3d::test::RandomNumbers;
using Index3 = std::array<std::int64_t, 3>;

template <class Inside>
Mask mask_of(const Index3& dims, const Eigen::Vector3d& spacing, const Inside& inside) {
  Mask mask;
  mask.dims = dims;
  mask.spacing = spacing;
  for (std::int64_t k = 0; k < dims[2]; ++k) {
    for (std::int64_t j = 0; j < dims[1]; ++j) {
      for (std::int64_t i = 0; i < dims[0]; ++i) mask.samples.push_back(inside(i, j, k) ? 1 : 0);
    }
  }
  return mask;
}

MaskView view(const Mask& mask) { return {mask.samples.data(), mask.dims, mask.spacing}; }

Mask random_mask(const Index3& dims, const Eigen::Vector3d& spacing, double share,
                 RandomNumbers& random) {
  return mask_of(dims, spacing, [&](std::int64_t, std::int64_t, std::int64_t) {
    return random.uniform() < share;
  });
}

Eigen::Vector3d place(const Mask& mask, std::size_t n) {
  const auto nx = static_cast<std::size_t>(mask.dims[0]),
             ny = static_cast<std::size_t>(mask.dims[1]);
  return Eigen::Vector3d(static_cast<double>(n % nx), static_cast<double>(n / nx % ny),
                         static_cast<double>(n / nx / ny))
      .cwiseProduct(mask.spacing);
}

// Surface samples by their definition, one neighbour after another.
std::vector<Eigen::Vector3d> surface(const Mask& mask) {
  std::vector<Eigen::Vector3d> points;
  std::size_t n = 0;
  for (std::int64_t k = 0; k < mask.dims[2]; ++k) {
    for (std::int64_t j = 0; j < mask.dims[1]; ++j) {
      for (std::int64_t i = 0; i < mask.dims[0]; ++i, ++n) {
        if (mask.samples[n] == 0) continue;
        bool on = false;
        for (int axis = 0; axis < 3; ++axis) {
          for (const int step : {-1, 1}) {
            Index3 p{i, j, k};
            p[static_cast<std::size_t>(axis)] += step;
            if (p[static_cast<std::size_t>(axis)] < 0 ||
                p[static_cast<std::size_t>(axis)] >= mask.dims[static_cast<std::size_t>(axis)])
              continue;
            on = on || mask.samples[static_cast<std::size_t>(mask.index(p))] == 0;
          }
        }
        if (on) points.push_back(place(mask, n));
      }
    }
  }
  return points;
}

double sorted_percentile(std::vector<double> values, double p) {
  std::sort(values.begin(), values.end());
  const double rank = p / 100 * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(rank);
  if (low + 1 == values.size()) return values[low];
  return values[low] + (rank - static_cast<double>(low)) * (values[low + 1] - values[low]);
}

TEST_CASE("distances are those of comparing all pairs, in any spacing", "[measures]") {
  RandomNumbers random(3);
  for (const double share : {0.002, 0.05, 0.5}) {
    const Eigen::Vector3d spacing(0.7, 1.3, 4.1);
    const Mask mask = random_mask({13, 9, 11}, spacing, share, random);
    const std::vector<float> squares = squared_distances(mask.samples, mask.dims, spacing);
    for (std::size_t n = 0; n < squares.size(); ++n) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t m = 0; m < squares.size(); ++m) {
        if (mask.samples[m] != 0)
          least = std::min(least, (place(mask, n) - place(mask, m)).squaredNorm());
      }
      // Each of the three passes rounds to float once: half an ulp, 6e-8.
      REQUIRE(static_cast<double>(squares[n]) == Approx(least).epsilon(2e-7));
    }
  }
}

TEST_CASE("nothing is infinitely far from nothing", "[measures]") {
  const std::vector<float> squares =
      squared_distances(std::vector<std::uint8_t>(24, 0), {4, 3, 2}, {1, 1, 1});
  for (const float square : squares) CHECK(square == std::numeric_limits<float>::infinity());
}

TEST_CASE("the measures of random masks are those of comparing all pairs", "[measures]") {
  RandomNumbers random(7);
  for (int round = 0; round < 6; ++round) {
    const Eigen::Vector3d spacing(0.5 + random.uniform(), 0.5 + random.uniform(), 2.0);
    const Mask a = random_mask({10, 8, 7}, spacing, 0.7, random);
    const Mask b = random_mask({10, 8, 7}, spacing, round < 3 ? 0.7 : 0.02, random);
    const SegmentationMeasures measures = compare_masks(view(a), view(b));
    const auto from_to = [](const std::vector<Eigen::Vector3d>& from,
                            const std::vector<Eigen::Vector3d>& to) {
      std::vector<double> distances;
      for (const auto& p : from) {
        double least = std::numeric_limits<double>::infinity();
        for (const auto& q : to) least = std::min(least, (p - q).norm());
        distances.push_back(least);
      }
      return distances;
    };
    std::vector<double> ab = from_to(surface(a), surface(b)), ba = from_to(surface(b), surface(a));
    int both = 0, sum = 0;
    for (std::size_t n = 0; n < a.samples.size(); ++n) {
      both += a.samples[n] & b.samples[n];
      sum += a.samples[n] + b.samples[n];
    }
    CHECK(measures.dice == Approx(2.0 * both / sum));
    CHECK(*measures.hausdorff95 ==
          Approx(std::max(sorted_percentile(ab, 95), sorted_percentile(ba, 95))).epsilon(1e-6));
    const double most =
        std::max(*std::max_element(ab.begin(), ab.end()), *std::max_element(ba.begin(), ba.end()));
    CHECK(*measures.hausdorff == Approx(most).epsilon(1e-6));
    ab.insert(ab.end(), ba.begin(), ba.end());
    double total = 0.0;
    for (const double d : ab) total += d;
    CHECK(*measures.mean_distance == Approx(total / static_cast<double>(ab.size())).epsilon(1e-6));
  }
}

TEST_CASE("two balls: distances of concentric and shifted spheres", "[measures]") {
  const auto ball = [](double radius, double shift) {
    return mask_of({60, 60, 30}, {1, 1, 2}, [=](std::int64_t i, std::int64_t j, std::int64_t k) {
      const double x = static_cast<double>(i) - 29.5 - shift, y = static_cast<double>(j) - 29.5,
                   z = 2 * (static_cast<double>(k) - 14.5);
      return x * x + y * y + z * z <= radius * radius;
    });
  };
  const Mask small = ball(15, 0), large = ball(20, 0), shifted = ball(15, 6);
  const SegmentationMeasures concentric = compare_masks(view(small), view(large));
  // All distances are 5, but for the digitisation: a sample is off the sphere by less than one
  // step, 2 at the most.
  CHECK(*concentric.mean_distance == Approx(5.0).margin(0.3));
  CHECK(*concentric.hausdorff95 == Approx(5.0).margin(2.0));
  CHECK(concentric.dice ==
        Approx(2 * 15.0 * 15 * 15 / (15.0 * 15 * 15 + 20.0 * 20 * 20)).epsilon(0.01));
  CHECK(*compare_masks(view(small), view(shifted)).hausdorff == Approx(6.0).margin(1e-5));
  // Overlap of two balls of radius r at distance d: π(4r + d)(2r − d)²/12.
  const double r = 15, d = 6, common = kPi * (4 * r + d) * (2 * r - d) * (2 * r - d) / 12;
  CHECK(compare_masks(view(small), view(shifted)).dice ==
        Approx(common / (4 * kPi / 3 * r * r * r)).epsilon(0.01));

  const MaskSize size = measure_mask(view(small));
  CHECK(size.volume == Approx(4 * kPi / 3 * 15 * 15 * 15).epsilon(0.01));
  CHECK(size.equivalent_diameter == Approx(30).epsilon(0.01));
  CHECK(size.axial_diameter == Approx(30).margin(1.0));
}

TEST_CASE("boxes have the sizes of boxes", "[measures]") {
  const Mask box =
      mask_of({12, 12, 6}, {0.5, 2, 3}, [](std::int64_t i, std::int64_t j, std::int64_t k) {
        return i >= 2 && i < 9 && j >= 3 && j < 7 && k >= 1 && k < 3;
      });
  const MaskSize size = measure_mask(view(box));
  CHECK(size.samples == 7 * 4 * 2);
  CHECK(size.volume == Approx(7 * 4 * 2 * 3.0));
  CHECK(size.axial_diameter == Approx(std::hypot(6 * 0.5, 3 * 2.0)));
  Mask point = box;
  std::fill(point.samples.begin(), point.samples.end(), std::uint8_t{0});
  CHECK(measure_mask(view(point)).axial_diameter == 0.0);
  CHECK(measure_mask(view(point)).volume == 0.0);
  point.samples[17] = 1;
  CHECK(measure_mask(view(point)).axial_diameter == 0.0);
  CHECK(measure_mask(view(point)).samples == 1);
}

TEST_CASE("empty masks: Dice 1 with each other, distances undefined", "[measures]") {
  const Mask none = mask_of({4, 4, 4}, {1, 1, 1}, [](auto, auto, auto) { return false; });
  const Mask some = mask_of({4, 4, 4}, {1, 1, 1}, [](auto i, auto, auto) { return i == 1; });
  const Mask all = mask_of({4, 4, 4}, {1, 1, 1}, [](auto, auto, auto) { return true; });
  CHECK(compare_masks(view(none), view(none)).dice == 1.0);
  CHECK(compare_masks(view(none), view(some)).dice == 0.0);
  CHECK_FALSE(compare_masks(view(none), view(some)).hausdorff95.has_value());
  CHECK_FALSE(compare_masks(view(all), view(some)).mean_distance.has_value());  // no surface
  const SegmentationMeasures same = compare_masks(view(some), view(some));
  CHECK(same.dice == 1.0);
  CHECK(*same.hausdorff == 0.0);
}

TEST_CASE("misuse of the measures is told", "[measures]") {
  const Mask a = mask_of({4, 4, 4}, {1, 1, 1}, [](auto, auto, auto) { return true; });
  const Mask b = mask_of({4, 4, 5}, {1, 1, 1}, [](auto, auto, auto) { return true; });
  Mask c = a;
  c.spacing[0] = 2;
  CHECK_THROWS_MATCHES(
      compare_masks(view(a), view(b)), std::invalid_argument,
      Message("mask a has 4 x 4 x 4 samples and mask b 4 x 4 x 5; expected as many"));
  CHECK_THROWS_MATCHES(compare_masks(view(a), view(c)), std::invalid_argument,
                       Message("mask a and mask b differ in spacing; expected the same"));
  CHECK_THROWS_MATCHES(measure_mask({}), std::invalid_argument,
                       Message("mask mask is 0 x 0 x 0 without data; expected one sample or more"));
  CHECK_THROWS_MATCHES(percentile({}, 50), std::invalid_argument,
                       Message("values is empty; expected one or more"));
  CHECK_THROWS_MATCHES(percentile({1}, 101), std::invalid_argument,
                       Message("p is 101; expected 0 to 100"));
  CHECK_THROWS_MATCHES(squared_distances({1, 0}, {1, 1, 1}, {1, 1, 1}), std::invalid_argument,
                       Message("marks has 2 samples; expected 1 x 1 x 1"));
  CHECK_THROWS_MATCHES(squared_distances({1}, {1, 1, 1}, {1, 0, 1}), std::invalid_argument,
                       Message("spacing[1] is 0; expected a finite positive number"));
  CHECK(percentile({4, 1, 3, 2, 5}, 50) == 3.0);
  CHECK(percentile({0, 10}, 95) == Approx(9.5));
}

TEST_CASE("components are joined by faces and parted at edges", "[labels]") {
  // Two cubes that share an edge, and one apart.
  const Mask mask = mask_of({9, 6, 3}, {1, 1, 1}, [](std::int64_t i, std::int64_t j, std::int64_t) {
    return (i < 3 && j < 3) || (i >= 3 && i < 6 && j >= 3) || (i >= 7 && j == 0);
  });
  CHECK(count_components(mask) == 3);
  const Mask first = component_at(mask, {1, 1, 1});
  CHECK(std::count(first.samples.begin(), first.samples.end(), 1) == 27);
  const Mask outside = component_at(mask, {6, 5, 0});
  CHECK(std::count(outside.samples.begin(), outside.samples.end(), 1) == 0);
  CHECK_THROWS_MATCHES(component_at(mask, {9, 0, 0}), std::invalid_argument,
                       Message("seed[0] is 9; expected 0 to 8"));
  CHECK(*nearest_inside(mask, {6.4, 0, 1}, 2.0) == Index3{7, 0, 1});
  CHECK_FALSE(nearest_inside(mask, {6.4, 2, 1}, 0.5).has_value());
}

TEST_CASE("an opening is what balls in the mask cover", "[labels]") {
  RandomNumbers random(5);
  const Mask mask = random_mask({14, 12, 8}, {1, 0.8, 1.7}, 0.93, random);
  const double radius = 1.75;
  const Mask opened = open_by_ball(mask, radius);
  // By the definition.
  Mask expected = mask;
  std::fill(expected.samples.begin(), expected.samples.end(), std::uint8_t{0});
  for (std::size_t centre = 0; centre < mask.samples.size(); ++centre) {
    bool fits = true;
    for (std::size_t n = 0; n < mask.samples.size(); ++n) {
      if ((place(mask, n) - place(mask, centre)).norm() <= radius)
        fits = fits && mask.samples[n] != 0;
    }
    if (!fits) continue;
    for (std::size_t n = 0; n < mask.samples.size(); ++n) {
      if ((place(mask, n) - place(mask, centre)).norm() <= radius) expected.samples[n] = 1;
    }
  }
  CHECK(opened.samples == expected.samples);
  CHECK(std::count(opened.samples.begin(), opened.samples.end(), 1) > 0);
  CHECK(open_by_ball(opened, radius).samples == opened.samples);  // idempotent
  CHECK(open_by_ball(mask, 0).samples == mask.samples);
  CHECK_THROWS_MATCHES(open_by_ball(mask, -1), std::invalid_argument,
                       Message("radius is -1; expected a finite number, 0 or more"));
}

TEST_CASE("a nodule is cut from a vessel and from a wall", "[labels]") {
  // A ball of 8, a vessel of radius 2 through it and a wall that it sinks into by half.
  const auto scene = [](bool vessel, bool wall) {
    return mask_of({60, 60, 40}, {1, 1, 1}, [=](std::int64_t i, std::int64_t j, std::int64_t k) {
      const double x = static_cast<double>(i) - 30, y = static_cast<double>(j) - 30,
                   z = static_cast<double>(k) - 20;
      return x * x + y * y + z * z <= 64 || (vessel && y * y + z * z <= 4) || (wall && x >= 4);
    });
  };
  const auto dice_with = [](const Mask& mask, const Mask& truth) {
    return compare_masks(view(mask), view(truth)).dice;
  };
  const Mask ball = scene(false, false);
  const Nodule alone = nodule_at(ball, {30, 30, 20});
  CHECK(alone.inscribed_radius == Approx(8).margin(1));
  CHECK(dice_with(alone.mask, ball) > 0.97);
  CHECK(dice_with(nodule_at(scene(true, false), {30, 30, 20}).mask, ball) > 0.95);
  CHECK(dice_with(nodule_at(ball, {32, 29, 21}).mask, ball) > 0.97);  // the seed off the middle
  Mask cap = ball;  // the part of the ball that is not in the wall
  for (std::size_t n = 0; n < cap.samples.size(); ++n) {
    if (place(cap, n).x() >= 34) cap.samples[n] = 0;
  }
  CHECK(dice_with(nodule_at(scene(false, true), {30, 30, 20}).mask, cap) > 0.93);
  CHECK(dice_with(nodule_at(scene(true, true), {30, 30, 20}).mask, cap) > 0.9);
  CHECK(dice_with(nodule_at(scene(false, true), {32, 29, 21}).mask, cap) > 0.93);
  const Mask in_wall = nodule_at(scene(false, true), {52, 30, 20}).mask;  // deep in the wall
  CHECK(std::count(in_wall.samples.begin(), in_wall.samples.end(), 1) == 0);
  // As if the lattice ended close behind the nodule: the wall goes on.
  Mask crop = mask_of({38, 60, 40}, {1, 1, 1},
                      [](std::int64_t, std::int64_t, std::int64_t) { return false; });
  Mask crop_cap = crop;
  const Mask whole = scene(false, true);
  for (std::int64_t k = 0; k < 40; ++k) {
    for (std::int64_t j = 0; j < 60; ++j) {
      for (std::int64_t i = 0; i < 38; ++i) {
        const auto to = static_cast<std::size_t>(crop.index({i, j, k}));
        crop.samples[to] = whole.samples[static_cast<std::size_t>(whole.index({i, j, k}))];
        crop_cap.samples[to] = cap.samples[static_cast<std::size_t>(cap.index({i, j, k}))];
      }
    }
  }
  CHECK(dice_with(nodule_at(crop, {30, 30, 20}).mask, crop_cap) > 0.93);
  const Nodule none = nodule_at(ball, {0, 0, 0});
  CHECK(std::count(none.mask.samples.begin(), none.mask.samples.end(), 1) == 0);
  NoduleOptions options;
  options.vessel_share = 1;
  CHECK_THROWS_MATCHES(nodule_at(ball, {30, 30, 20}, options), std::invalid_argument,
                       Message("vessel_share is 1; expected 0 or more, below 1"));
  options = {};
  options.radius = -1;
  CHECK_THROWS_MATCHES(nodule_at(ball, {30, 30, 20}, options), std::invalid_argument,
                       Message("radius is -1; expected a finite number of mm, 0 or more"));
  CHECK_THROWS_MATCHES(nodule_at(ball, {30, 60, 20}), std::invalid_argument,
                       Message("seed[1] is 60; expected 0 to 59"));
  // A radius that is given: nothing farther than twice it.
  options.radius = 3;
  const Mask near = nodule_at(ball, {30, 30, 20}, options).mask;
  for (std::size_t n = 0; n < near.samples.size(); ++n) {
    if (near.samples[n] != 0) CHECK((place(near, n) - Eigen::Vector3d(30, 30, 20)).norm() <= 6.0);
  }
  CHECK(std::count(near.samples.begin(), near.samples.end(), 1) > 800);
  options = {};
  options.wall_share = 1;
  CHECK_THROWS_MATCHES(nodule_at(ball, {30, 30, 20}, options), std::invalid_argument,
                       Message("wall_share is 1; expected more than 1"));
}

}  // namespace
