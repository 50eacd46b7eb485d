// The development data, read here and by an independent script.

#include <zlib.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "common/volume_info.hpp"
#include "common/volume_io.hpp"
#include "support/test_data.hpp"

namespace {

using namespace shape3d::apps;
using namespace shape3d::test;

std::uint64_t crc_of(const Volume& volume) {
  uLong crc = crc32(0, nullptr, 0);
  const auto* bytes = reinterpret_cast<const Bytef*>(volume.samples.data());
  return crc32_z(crc, bytes, volume.samples.size());
}

Eigen::Vector3d vector(const nlohmann::json& json) {
  const auto numbers = json.get<std::array<double, 3>>();
  return {numbers[0], numbers[1], numbers[2]};
}

TEST_CASE("real volumes are what an independent reading finds", "[volume][data]") {
  const auto root = test_data("");
  if (!root) {
    WARN("SHAPE3D_DATA names no folder: nothing to test");
    return;
  }
  const TemporaryFolder folder;
  const std::string command = std::string(SHAPE3D_TEST_PYTHON) + " " + SHAPE3D_TEST_SCRIPTS +
                              "/read_volumes.py " + root->string() + " " +
                              (folder / "found.json").string();
  REQUIRE(std::system(command.c_str()) == 0);
  nlohmann::json expected;
  std::ifstream(folder / "found.json") >> expected;
  CHECK(expected.size() > 0);
  for (const auto& entry : expected) {
    const std::string file = entry.at("file").get<std::string>();
    INFO(file);
    const Volume volume = read_volume(*root / file);
    const VolumeDescription found = describe_volume(volume);
    CHECK(found.dims == entry.at("dims").get<std::array<std::int64_t, 3>>());
    CHECK(to_string(found.type) == entry.at("type").get<std::string>());
    CHECK(found.minimum == entry.at("minimum").get<double>());
    CHECK(found.maximum == entry.at("maximum").get<double>());
    CHECK(found.mean == Approx(entry.at("mean").get<double>()).epsilon(1e-12));
    CHECK(crc_of(volume) == entry.at("crc").get<std::uint64_t>());
    CHECK((volume.view.world({0, 0, 0}) - vector(entry.at("first"))).norm() < 1e-9);
    const Eigen::Vector3d last(static_cast<double>(found.dims[0] - 1),
                               static_cast<double>(found.dims[1] - 1),
                               static_cast<double>(found.dims[2] - 1));
    CHECK((volume.view.world(last) - vector(entry.at("last"))).norm() < 1e-9);
    CHECK(volume.warnings.empty());
  }
}

}  // namespace
