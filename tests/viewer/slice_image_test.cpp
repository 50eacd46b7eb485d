#include "viewer/model/slice_image.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "viewer/model/place_text.hpp"
#include "viewer/model/samples_at.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::apps::viewer;

// 5 × 4 × 3 samples, value 100 i + 10 j + k.
std::vector<float> numbered() {
  std::vector<float> samples;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 5; ++i) samples.push_back(static_cast<float>(100 * i + 10 * j + k));
    }
  }
  return samples;
}

// All permutations of axes with all signs.
std::vector<Eigen::Matrix3d> directions() {
  std::vector<Eigen::Matrix3d> result;
  const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (const auto& order : orders) {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d d = Eigen::Matrix3d::Zero();
      for (int axis = 0; axis < 3; ++axis)
        d(order[axis], axis) = (signs >> axis & 1) != 0 ? -1.0 : 1.0;
      result.push_back(d);
    }
  }
  return result;
}

TEST_CASE("pixels show the samples under them, whatever the direction", "[viewer][slice]") {
  const std::vector<float> samples = numbered();
  const Window window{250.0, 500.0};
  for (const Eigen::Matrix3d& direction : directions()) {
    zmc::VolumeView view = zmc::make_view(samples.data(), {5, 4, 3}, {1.0, 2.0, 3.0});
    view.direction = direction;
    for (int axis = 0; axis < 3; ++axis) {
      const SliceGeometry geometry(view, axis);
      const std::int64_t slice = geometry.slices() - 1;
      const auto image = slice_image(view, geometry, slice, window);
      for (int row = 0; row < geometry.rows(); ++row) {
        for (int column = 0; column < geometry.columns(); ++column) {
          const auto p = geometry.sample(column, row, slice);
          const double value = sample_at(view, p);
          const auto grey = image[static_cast<std::size_t>(row * geometry.columns() + column)];
          CHECK(std::abs(grey - 255.0 * std::clamp(value / 500.0, 0.0, 1.0)) <= 0.5 + 1e-9);
          // The middle of the pixel is the place of the sample, both ways.
          const Eigen::Vector3d lattice(static_cast<double>(p[0]), static_cast<double>(p[1]),
                                        static_cast<double>(p[2]));
          const auto place = geometry.place(lattice);
          CHECK(place[0] == Approx((column + 0.5) * geometry.size()[0] / geometry.columns()));
          CHECK(place[1] == Approx((row + 0.5) * geometry.size()[1] / geometry.rows()));
          CHECK(geometry.lattice(place, static_cast<double>(slice)).isApprox(lattice));
        }
      }
    }
  }
}

TEST_CASE("slices are seen as a radiologist sees them", "[viewer][slice]") {
  const std::vector<float> samples = numbered();
  for (const Eigen::Matrix3d& direction : directions()) {
    zmc::VolumeView view = zmc::make_view(samples.data(), {5, 4, 3});
    view.direction = direction;
    int names = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const SliceGeometry geometry(view, axis);
      const std::string name = geometry.name();
      // The line of the lattice that leads to the right of the picture, in the world.
      const auto at = [&](double x, double y) { return view.world(geometry.lattice({x, y}, 0.0)); };
      const Eigen::Vector3d right = at(1.0, 0.0) - at(0.0, 0.0), down = at(0.0, 1.0) - at(0.0, 0.0);
      const bool turned = std::abs(right.z()) > 0.5;  // superior lies across: a turned lattice
      if (name == "axial" && !turned && std::abs(right.x()) > 0.5) {
        CHECK(right.x() > 0.0);  // the patient's left
        CHECK(down.y() > 0.0);   // posterior
      }
      if (name != "axial" && !turned) CHECK(down.z() < 0.0);  // superior up
      const auto sides = geometry.sides();
      Eigen::Index dominant = 0;
      right.cwiseAbs().maxCoeff(&dominant);
      CHECK(sides[1] == std::string(1, (right[dominant] > 0 ? "LPS" : "RAI")[dominant]));
      CHECK(sides[0] == std::string(1, (right[dominant] > 0 ? "RAI" : "LPS")[dominant]));
      names += name == "axial" ? 1 : name == "coronal" ? 10 : 100;
    }
    CHECK(names == 111);
  }
}

TEST_CASE("the window's ends, and NaN, are black and white", "[viewer][slice]") {
  std::vector<float> samples{
      -5.0F, 0.0F, 60.0F, 100.0F, 1e30F, std::numeric_limits<float>::quiet_NaN(), -1e30F, 25.0F};
  const zmc::VolumeView view = zmc::make_view(samples.data(), {2, 2, 2});
  const SliceGeometry geometry(view, 2);
  CHECK(slice_image(view, geometry, 0, {50.0, 100.0}) == std::vector<std::uint8_t>{0, 0, 153, 255});
  CHECK(slice_image(view, geometry, 1, {50.0, 100.0}) == std::vector<std::uint8_t>{255, 0, 0, 64});
}

TEST_CASE("the contour of a ball is the circle of the slice, closed", "[viewer][slice]") {
  constexpr int n = 40;
  std::vector<float> samples;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i)
        samples.push_back(static_cast<float>(Eigen::Vector3d(i - 19.5, j - 19.5, k - 19.5).norm()));
    }
  }
  const zmc::VolumeView view = zmc::make_view(samples.data(), {n, n, n}, {0.5, 0.5, 0.5});
  for (int axis = 0; axis < 3; ++axis) {
    const SliceGeometry geometry(view, axis);
    for (const std::int64_t slice : {10, 20, 25, 39}) {
      const double off = static_cast<double>(slice) - 19.5;
      const auto lines = slice_contour(view, geometry, 12.0, slice);
      if (std::abs(off) > 12.0) {
        CHECK(lines.empty());
        continue;
      }
      REQUIRE(lines.size() == 1);
      CHECK(lines[0].front() == lines[0].back());
      const double radius = 0.5 * std::sqrt(144.0 - off * off);
      for (const auto& [x, y] : lines[0])
        CHECK(std::hypot(x - 10.0, y - 10.0) == Approx(radius).margin(0.02));
      // Classified with the whole volume: the same, as there is no cell of eight zeros.
      CHECK(slice_contour(view, geometry, 12.0, slice, true) == lines);
    }
  }
}

TEST_CASE("the line under the slices", "[viewer][slice]") {
  const std::vector<float> samples = numbered();
  const zmc::VolumeView view =
      zmc::make_view(samples.data(), {5, 4, 3}, {1.0, 2.0, 3.0}, {10.0, 20.0, 30.0});
  CHECK(place_text(view, {2.0, 1.0, 2.0}) == "L 12.0  P 22.0  S 36.0 mm   voxel 2 1 2   value 212");
  CHECK(place_text(view, {2.4, 0.6, 2.0}) == "L 12.4  P 21.2  S 36.0 mm   voxel 2 1 2   value 212");
  CHECK(place_text(view, {5.0, 1.0, 2.0}) == "L 15.0  P 22.0  S 36.0 mm   outside the volume");
}

}  // namespace
