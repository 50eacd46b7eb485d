#include "shape3d/levelset/front.hpp"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

namespace {
using namespace shape3d::levelset;
using Catch::Contains;

TEST_CASE("the box of the whole grid holds its border slices", "[levelset]") {
  const Grid grid{{6, 5, 4}, {0.5, 1.0, 3.0}};
  const Field psi = box_front(grid, {{0, 0, 0}, grid.dims});
  CHECK((psi < 0.0F).all());
  CHECK(psi[grid.index(0, 2, 2)] == -0.25F);  // half a spacing to the face
  CHECK(psi[grid.index(2, 2, 0)] == -1.25F);  // five halves of 0.5 along x
  CHECK(psi[grid.index(2, 0, 1)] == -0.5F);
}

TEST_CASE("a box has its distance outside, too", "[levelset][analytic]") {
  const Grid grid{{20, 20, 20}, {1.0, 1.0, 2.0}};
  const Field psi = box_front(grid, {{5, 5, 5}, {10, 10, 10}});
  CHECK(psi[grid.index(7, 7, 7)] == -2.5F);
  CHECK(psi[grid.index(12, 7, 7)] == 2.5F);  // faces at 9.5
  CHECK(psi[grid.index(12, 13, 7)] == Approx(std::hypot(2.5, 3.5)));
  CHECK(psi[grid.index(2, 7, 12)] == Approx(std::hypot(2.5, 5.0)));
}

TEST_CASE("a sphere is one in millimetres", "[levelset][analytic]") {
  const Grid grid{{21, 21, 11}, {0.5, 0.5, 2.0}};
  const Field psi = sphere_front(grid, {10, 10, 5}, 4.0);
  CHECK(psi[grid.index(10, 10, 5)] == -4.0F);
  CHECK(psi[grid.index(18, 10, 5)] == 0.0F);
  CHECK(psi[grid.index(10, 10, 7)] == 0.0F);
  CHECK(psi[grid.index(10, 10, 9)] == 4.0F);
}

TEST_CASE("redistancing gives the distance, to first order, and keeps signs and zeros",
          "[levelset][analytic]") {
  for (const double h : {1.0, 0.5}) {
    const auto n = static_cast<std::int64_t>(24 / h) + 1;
    const Grid grid{{n, n, n}, {h, h, h}};
    const Eigen::Vector3d centre = Eigen::Vector3d::Constant(12.0 / h);
    const Field exact = sphere_front(grid, centre, 8.0);
    const Field bent = exact * (1.0F + 0.3F * exact.abs()) * 5.0F;  // same zeros, no distance
    const Field found = redistance(grid, bent, 3.0);
    double worst = 0.0;
    for (Eigen::Index i = 0; i < found.size(); ++i) {
      CHECK((found[i] < 0.0F) == (exact[i] < 0.0F));
      CHECK((found[i] == 0.0F) == (exact[i] == 0.0F));
      if (std::abs(exact[i]) < 2.5F)
        worst = std::max(worst, static_cast<double>(std::abs(found[i] - exact[i])));
    }
    INFO("h = " << h << ", worst " << worst);
    CHECK(worst < 0.3 * h);
    CHECK(found.abs().maxCoeff() == 3.0F);
    CHECK((redistance(grid, bent, 3.0, 3) == found).all());
  }
}

TEST_CASE("redistancing leaves an object of one node in its place", "[levelset]") {
  // The crossings at 0.4 of each edge stay there however often it is done.
  const Grid grid{{9, 9, 9}, {1, 1, 1}};
  Field psi = Field::Constant(grid.size(), 0.6F);
  psi[grid.index(4, 4, 4)] = -0.4F;
  for (int n = 0; n < 20; ++n) psi = redistance(grid, psi, 3.0);
  CHECK(psi[grid.index(4, 4, 4)] == Approx(-0.4F));
  CHECK(psi[grid.index(5, 4, 4)] == Approx(0.6F));
}

TEST_CASE("a label map is inside where it has labels", "[levelset]") {
  const Grid grid{{10, 9, 8}, {1, 1, 2}};
  Eigen::Array<std::uint8_t, -1, 1> labels = Eigen::Array<std::uint8_t, -1, 1>::Zero(grid.size());
  for (std::int64_t k = 2; k < 5; ++k)
    for (std::int64_t j = 3; j < 7; ++j)
      for (std::int64_t i = 2; i < 8; ++i) labels[grid.index(i, j, k)] = 7;
  const Field psi = label_front(grid, labels);
  CHECK(((psi < 0.0F) == (labels != 0)).all());
  CHECK(psi[grid.index(4, 5, 4)] == Approx(-1.0));  // half of 2 mm to the face along z
  CHECK(psi[grid.index(8, 5, 3)] == Approx(0.5));
}

TEST_CASE("start fronts that are none are refused", "[levelset][contract]") {
  const Grid grid{{8, 8, 8}, {1, 1, 1}};
  CHECK_THROWS_WITH(
      box_front(grid, {{3, 0, 0}, {3, 8, 8}}),
      Contains("box: range of axis x is [3, 3); expected a non-empty range within [0, 8)"));
  CHECK_THROWS_WITH(box_front(grid, {{0, 0, 0}, {8, 9, 8}}), Contains("axis y is [0, 9)"));
  CHECK_THROWS_WITH(sphere_front(grid, {4, 4, 7.5}, 2.0),
                    Contains("seed point: z is 7.5; expected a lattice coordinate within [0, 7]"));
  CHECK_THROWS_WITH(sphere_front(grid, {4, 4, 4}, 0.0), Contains("radius is 0"));
  CHECK_THROWS_WITH(redistance(grid, Field::Ones(7), 1.0),
                    Contains("psi: size is 7; expected 512"));
  CHECK_THROWS_WITH(redistance(grid, Field::Ones(512), -1.0), Contains("limit is -1"));
  Field bad = Field::Ones(512);
  bad[3] = std::numeric_limits<float>::infinity();
  CHECK_THROWS_WITH(redistance(grid, bad, 1.0), Contains("psi[3] is inf"));
  CHECK_THROWS_WITH(label_front(grid, Eigen::Array<std::uint8_t, -1, 1>::Zero(5)),
                    Contains("labels: size is 5"));
}
}  // namespace
