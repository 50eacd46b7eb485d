#include "common/slice_geometry.hpp"

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "common/error.hpp"

namespace {

using namespace shape3d::apps;

/// Slices of a sheared lattice with the given step, in a random orientation and order.
struct Stack {
  Eigen::Matrix3d steps;
  Eigen::Vector3d origin;
  std::vector<SlicePlace> slices;
  std::vector<std::size_t> numbers;  ///< numbers[n]: which slice of the lattice slices[n] is.
};

Stack make_stack(unsigned seed, std::size_t count, const Eigen::Vector3d& step) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Eigen::Matrix3d turn =
      Eigen::Quaterniond(uniform(random), uniform(random), uniform(random), uniform(random))
          .normalized()
          .toRotationMatrix();
  Stack stack;
  stack.steps << 0.7 * turn.col(0), 0.9 * turn.col(1), turn * step;
  stack.origin = 100.0 * Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
  for (std::size_t k = 0; k < count; ++k) stack.numbers.push_back(k);
  std::shuffle(stack.numbers.begin(), stack.numbers.end(), random);
  for (const std::size_t k : stack.numbers) {
    SlicePlace slice;
    slice.position = stack.origin + static_cast<double>(k) * stack.steps.col(2);
    slice.row = turn.col(0);
    slice.column = turn.col(1);
    slice.column_spacing = 0.7;
    slice.row_spacing = 0.9;
    slice.name = "s" + std::to_string(k);
    stack.slices.push_back(slice);
  }
  return stack;
}

SlicePlace& slice_number(Stack& stack, std::size_t k) {
  const auto found = std::find(stack.numbers.begin(), stack.numbers.end(), k);
  return stack.slices[static_cast<std::size_t>(found - stack.numbers.begin())];
}

std::string error_of(const std::vector<SlicePlace>& slices) {
  try {
    static_cast<void>(stack_slices(slices, "series"));
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

TEST_CASE("slices of a lattice are put in order, whatever theirs", "[slices]") {
  const auto seed = GENERATE(range(1U, 30U));
  const auto count = GENERATE(std::size_t{2}, std::size_t{3}, std::size_t{40});
  const Stack made = make_stack(seed, count, {0.0, 0.0, 2.5});
  const SliceStack found = stack_slices(made.slices, "series");
  CHECK((found.steps - made.steps).norm() < 1e-11);
  CHECK((found.origin - made.origin).norm() < 1e-11);
  REQUIRE(found.order.size() == count);
  for (std::size_t k = 0; k < count; ++k) CHECK(made.numbers[found.order[k]] == k);
  CHECK(found.warnings.empty());
}

TEST_CASE("a stack against the normal is turned round, so that its axes are right-handed",
          "[slices]") {
  const Stack made = make_stack(5, 7, {0.0, 0.0, -2.5});
  const SliceStack found = stack_slices(made.slices, "series");
  CHECK(found.steps.determinant() == Approx(0.7 * 0.9 * 2.5));
  CHECK((found.origin - (made.origin + 6.0 * made.steps.col(2))).norm() < 1e-11);
  CHECK((found.steps.col(2) + made.steps.col(2)).norm() < 1e-11);
}

TEST_CASE("a tilted gantry shears the stack and is reported", "[slices]") {
  // tan 20° = 0.36397.
  const Stack made = make_stack(9, 12, {0.0, 0.3639702342662024 * 3.0, 3.0});
  const SliceStack found = stack_slices(made.slices, "series");
  CHECK((found.steps - made.steps).norm() < 1e-11);
  REQUIRE(found.warnings.size() == 1);
  CHECK_THAT(found.warnings[0], Catch::Contains("sheared by 20 degrees"));
}

TEST_CASE("positions rounded to a thousandth of a millimetre are a lattice", "[slices]") {
  Stack made = make_stack(3, 50, {0.0, 0.0, 1.25});
  for (SlicePlace& slice : made.slices) {
    for (int n = 0; n < 3; ++n) slice.position[n] = std::round(1000.0 * slice.position[n]) / 1000.0;
  }
  const SliceStack found = stack_slices(made.slices, "series");
  CHECK(found.warnings.empty());
  CHECK((found.steps - made.steps).norm() < 1e-4);
}

TEST_CASE("each missing slice is counted, with its neighbours", "[slices]") {
  const auto removed = GENERATE(std::size_t{1}, std::size_t{4}, std::size_t{8});
  Stack made = make_stack(11, 10, {0.0, 0.0, 4.0});
  const SlicePlace* gone = &slice_number(made, removed);
  made.slices.erase(made.slices.begin() + (gone - made.slices.data()));
  const std::string before = "s" + std::to_string(removed - 1);
  const std::string after = "s" + std::to_string(removed + 1);
  CHECK_THAT(error_of(made.slices),
             Catch::StartsWith("series: 1 slice is missing where most are 4 mm apart: 1 between " +
                               before + " and " + after + ", 8 mm apart"));
}

TEST_CASE("a missing slice among three is noticed", "[slices]") {
  Stack made = make_stack(13, 4, {0.0, 0.0, 4.0});
  const SlicePlace* gone = &slice_number(made, 2);
  made.slices.erase(made.slices.begin() + (gone - made.slices.data()));
  CHECK_THAT(error_of(made.slices), Catch::Contains("1 slice is missing"));
}

TEST_CASE("a slice off the lattice is an error from 5 % of the step on, a warning from 1 %",
          "[slices]") {
  const Eigen::Vector3d directions[] = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(),
                                        Eigen::Vector3d(0.0, 0.6, 0.8)};
  for (const Eigen::Vector3d& direction : directions) {
    for (const double part : {0.004, 0.02, 0.04, 0.06, 0.3}) {
      Stack made = make_stack(17, 9, {0.0, 0.0, 4.0});
      Eigen::Matrix3d axes;
      axes << made.steps.col(0).normalized(), made.steps.col(1).normalized(),
          made.steps.col(2).normalized();
      slice_number(made, 4).position += part * 4.0 * axes * direction;
      INFO("off by " << part << " along " << direction.transpose());
      const std::string error = error_of(made.slices);
      if (part > 0.05) {
        CHECK_THAT(error, Catch::Contains("unevenly spaced") && Catch::Contains("s4"));
      } else {
        REQUIRE(error.empty());
        const SliceStack found = stack_slices(made.slices, "series");
        CHECK(found.warnings.size() == (part > 0.01 ? 1 : 0));
        CHECK((found.steps - made.steps).norm() < 1e-11);
      }
    }
  }
}

TEST_CASE("volumes at the same place are counted", "[slices]") {
  std::vector<SlicePlace> slices;
  for (int phase = 0; phase < 3; ++phase) {
    const Stack made = make_stack(19, 6, {0.0, 0.0, 2.0});
    slices.insert(slices.end(), made.slices.begin(), made.slices.end());
  }
  CHECK_THAT(error_of(slices), Catch::Contains("holds 3 frames (4-D), volumes at the same place"));
  slices.pop_back();
  CHECK_THAT(error_of(slices), Catch::Contains("several slices at one place"));
  const std::vector<SlicePlace> same(4, slices[0]);
  CHECK_THAT(error_of(same), Catch::Contains("several slices at one place"));
}

TEST_CASE("slices that are none of a volume are refused", "[slices]") {
  const Stack made = make_stack(23, 5, {0.0, 0.0, 2.0});
  CHECK_THAT(error_of({}), Catch::Contains("holds 0 slice"));
  CHECK_THAT(error_of({made.slices[0]}),
             Catch::Contains("holds 1 slice; a volume needs at least two"));
  const auto changed = [&](auto change) {
    std::vector<SlicePlace> slices = made.slices;
    change(slices[3]);
    return error_of(slices);
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THAT(changed([](SlicePlace& s) { s.position[1] = kNan; }),
             Catch::Contains("is not finite"));
  CHECK_THAT(changed([](SlicePlace& s) { s.row[1] = kNan; }), Catch::Contains("is not finite"));
  CHECK_THAT(changed([](SlicePlace& s) { s.row *= 1.01; }),
             Catch::Contains("orthogonal unit vectors"));
  CHECK_THAT(changed([](SlicePlace& s) { s.column = s.row; }),
             Catch::Contains("orthogonal unit vectors"));
  CHECK_THAT(changed([](SlicePlace& s) { s.row = -s.row; }),
             Catch::Contains("differ in orientation"));
  CHECK_THAT(changed([](SlicePlace& s) { s.row_spacing = 0.95; }),
             Catch::Contains("differ in pixel spacing: 0.9 x 0.7"));
  CHECK_THAT(changed([](SlicePlace& s) { s.row_spacing = 0.0; }),
             Catch::Contains("pixel spacing 0;"));
  CHECK_THAT(changed([](SlicePlace& s) { s.column_spacing = -0.7; }),
             Catch::Contains("pixel spacing -0.7;"));
  CHECK_THAT(changed([](SlicePlace& s) { s.column_spacing = kNan; }),
             Catch::Contains("pixel spacing nan;"));
}

}  // namespace
