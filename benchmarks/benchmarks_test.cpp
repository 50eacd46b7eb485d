// The parts of the benchmarks that figures rest on: statistics, the generated volumes, the list of
// volumes.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include <catch2/catch.hpp>
#include <shape3d/zmc/extract.hpp>

#include "common/error.hpp"
#include "ct_volume.hpp"
#include "statistics.hpp"
#include "subjects.hpp"
#include "support/test_data.hpp"
#include "volume_list.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::bench;

TEST_CASE("median and quartiles of a known series", "[benchmarks]") {
  const Spread odd = spread({5, 1, 4, 2, 3});
  CHECK(odd.median == 3);
  CHECK(odd.lower == 2);
  CHECK(odd.upper == 4);
  CHECK(spread({1, 2}).median == 1.5);
  CHECK(spread({7}).lower == 7);
}

TEST_CASE("ratios are taken pair by pair over the common rounds", "[benchmarks]") {
  CHECK(pairwise_ratios({6, 8, 10}, {3, 2}) == std::vector<double>{2, 4});
}

TEST_CASE("fits return the law that the times were made by", "[benchmarks]") {
  const std::vector<double> x{1, 3, 7, 20, 41}, y{2, 1, 9, 4, 30};
  std::vector<double> plane, power;
  for (std::size_t i = 0; i < x.size(); ++i) {
    plane.push_back(0.3 * x[i] + 1.7 * y[i]);
    power.push_back(0.02 * std::pow(x[i], 1.25));
  }
  const Plane fitted = fit_plane(x, y, plane);
  CHECK(fitted.a == Approx(0.3));
  CHECK(fitted.b == Approx(1.7));
  CHECK(fitted.largest_error < 1e-12);
  CHECK(fit_exponent(x, power) == Approx(1.25));
}

// Marching Cubes triangles by VTK; the share of crossed cell faces with a zero sample.
TEST_CASE("a generated volume has the triangles of Table 3.1", "[benchmarks]") {
  const CtSize& size = GENERATE(kCtSizes[0], kCtSizes[1]);
  const std::vector<std::int16_t> samples = make_ct_volume(size.dims, size.wavelength);
  const Source source{zmc::make_view(samples.data(), size.dims), kCtIsovalue, {}};
  for (const Method method : {Method::flying_edges, Method::marching_cubes}) {
    const Measurement mc = make_subject({method, 1}, source)->run();
    INFO(size.name << ", " << to_string(method));
    CHECK(static_cast<double>(mc.triangles) / 1e6 == Approx(size.mc_triangles).epsilon(0.01));
  }
  zmc::Surface<float, std::int32_t> surface;
  REQUIRE(zmc::extract(source.view, kCtIsovalue, {}, surface) == zmc::Status::ok);
  double crossed = 0, with_zero = 0;
  for (std::size_t c = 0; c < 13; ++c) {
    const double faces = static_cast<double>(surface.counts.faces_by_case[c]);
    if (c == 0 || c == 1 || c == 6) continue;
    crossed += faces;
    if (c != 2 && c != 5 && c != 12) with_zero += faces;
  }
  CHECK(with_zero / crossed > 0.02);
  CHECK(with_zero / crossed < 0.04);
}

TEST_CASE("the seed decides the generated volume", "[benchmarks]") {
  const std::array<std::int64_t, 3> dims{40, 30, 8};
  const std::vector<std::int16_t> samples = make_ct_volume(dims, 16, 1);
  CHECK(samples.size() == 40 * 30 * 8);
  CHECK(samples == make_ct_volume(dims, 16, 1));
  CHECK(samples != make_ct_volume(dims, 16, 2));
  CHECK(*std::min_element(samples.begin(), samples.end()) >= -1024);
  CHECK(*std::max_element(samples.begin(), samples.end()) <= 3071);
}

TEST_CASE("extractors count the same with memory fresh or reused", "[benchmarks]") {
  const std::array<std::int64_t, 3> dims{64, 64, 16};
  const std::vector<std::int16_t> samples = make_ct_volume(dims, 16);
  const test::TemporaryFolder folder;
  const std::string file = folder / "samples";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(samples.data()),
             static_cast<std::streamsize>(2 * samples.size()));
  const Source source{zmc::make_view(samples.data(), dims), kCtIsovalue, file};
  const SubjectName fresh{Method::zmc_compact, 1}, reused{Method::zmc_compact_reused, 2};
  const Measurement here = make_subject(fresh, source)->run();
  CHECK(here.triangles > 1000);
  const std::unique_ptr<Subject> again = make_subject(reused, source);
  again->run();
  CHECK(again->run().triangles == here.triangles);
}

TEST_CASE("volumes of a folder, and isovalues after @", "[benchmarks]") {
  const test::TemporaryFolder folder;
  for (const char* name : {"b", "a"}) {
    std::ofstream(folder / (std::string(name) + ".mhd"))
        << "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
           "ElementDataFile = data.raw\n";
  }
  std::ofstream(folder / "data.raw", std::ios::binary) << "\1\2\3\4\5\6\7\11";
  const std::vector<ListedVolume> both = volumes_at(folder.path());
  REQUIRE(both.size() == 2);
  CHECK(both[0].load().name == "a");
  CHECK(both[0].load().isovalue == 5);  // halfway between 1 and 9
  const std::string file = folder / "a.mhd";
  CHECK(volumes_at(file + "@2.5").at(0).load().isovalue == 2.5);
  CHECK_THROWS_WITH(volumes_at(file + "@two"),
                    Catch::Contains("isovalue is 'two'") && Catch::Contains("a finite number"));
  CHECK_THROWS_WITH(volumes_at(file + "@inf"), Catch::Contains("isovalue is 'inf'"));
  CHECK_THROWS_AS(volumes_at(folder / "missing"), apps::FileError);
  std::filesystem::create_directory(folder / "empty");
  CHECK_THROWS_WITH(volumes_at(folder / "empty"), Catch::Contains("no MetaImage"));
}

}  // namespace
