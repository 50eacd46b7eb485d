#include "viewer/model/coarse_volume.hpp"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

namespace {
using namespace shape3d;
using namespace shape3d::apps::viewer;

std::vector<float> linear(const std::array<std::int64_t, 3>& dims) {
  std::vector<float> samples;
  for (std::int64_t k = 0; k < dims[2]; ++k) {
    for (std::int64_t j = 0; j < dims[1]; ++j) {
      for (std::int64_t i = 0; i < dims[0]; ++i)
        samples.push_back(static_cast<float>(3 * i - 2 * j + 5 * k));
    }
  }
  return samples;
}

TEST_CASE("a linear field stays itself at the places of the blocks", "[viewer][coarse]") {
  // Block means of a linear function are its values at the middles of the blocks.
  const std::array<std::int64_t, 3> dims{32, 16, 8};
  const std::vector<float> samples = linear(dims);
  zmc::VolumeView view = zmc::make_view(samples.data(), dims, {0.5, 1.0, 2.0}, {10.0, 20.0, 30.0});
  const CoarseVolume coarse = coarsen(view, 600);
  CHECK(coarse.factors == std::array<std::int64_t, 3>{4, 2, 1});
  REQUIRE(coarse.view.dims == std::array<std::int64_t, 3>{8, 8, 8});
  CHECK(coarse.view.data == coarse.samples.data());
  for (std::int64_t k = 0; k < 8; ++k) {
    for (std::int64_t j = 0; j < 8; ++j) {
      for (std::int64_t i = 0; i < 8; ++i) {
        const Eigen::Vector3d p = coarse.view.world(
            {static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
        // The field as a function of the world.
        const double expected =
            3 * (p.x() - 10) / 0.5 - 2 * (p.y() - 20) / 1.0 + 5 * (p.z() - 30) / 2.0;
        CHECK(coarse.samples[static_cast<std::size_t>(i + 8 * (j + 8 * k))] ==
              Approx(expected).margin(1e-4));
      }
    }
  }
}

TEST_CASE("a small volume keeps its samples", "[viewer][coarse]") {
  const std::array<std::int64_t, 3> dims{5, 4, 3};
  const std::vector<float> samples = linear(dims);
  const CoarseVolume coarse = coarsen(zmc::make_view(samples.data(), dims), 60);
  CHECK(coarse.factors == std::array<std::int64_t, 3>{1, 1, 1});
  CHECK(coarse.samples == samples);
}

TEST_CASE("smaller blocks at the border and thin volumes", "[viewer][coarse]") {
  const std::array<std::int64_t, 3> dims{9, 2, 2};
  const std::vector<float> samples = linear(dims);
  const CoarseVolume coarse = coarsen(zmc::make_view(samples.data(), dims), 20);
  // Two blocks at least along each axis: only x can be made coarser.
  CHECK(coarse.factors == std::array<std::int64_t, 3>{2, 1, 1});
  CHECK(coarse.view.dims == std::array<std::int64_t, 3>{5, 2, 2});
  CHECK(coarse.samples[4] == Approx(3 * 8));  // one sample alone
}

TEST_CASE("a sample that is not finite makes its block NaN and no other", "[viewer][coarse]") {
  const std::array<std::int64_t, 3> dims{8, 8, 8};
  std::vector<float> samples = linear(dims);
  samples[0] = std::numeric_limits<float>::quiet_NaN();
  const CoarseVolume coarse = coarsen(zmc::make_view(samples.data(), dims), 64);
  CHECK(std::isnan(coarse.samples[0]));
  for (std::size_t n = 1; n < coarse.samples.size(); ++n) CHECK(std::isfinite(coarse.samples[n]));
}

TEST_CASE("strides are followed", "[viewer][coarse]") {
  const std::array<std::int64_t, 3> dims{8, 8, 8};
  const std::vector<float> samples = linear(dims);
  zmc::VolumeView turned = zmc::make_view(samples.data(), dims);
  turned.strides = {64, 8, 1};  // x and z exchanged
  const CoarseVolume coarse = coarsen(turned, 64);
  CHECK(coarse.samples[1] - coarse.samples[0] == Approx(2 * 5));
}

}  // namespace
