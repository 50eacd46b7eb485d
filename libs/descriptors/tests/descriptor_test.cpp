#include "shape3d/descriptors/descriptor.hpp"

#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "meshes.hpp"

namespace {
using namespace shape3d::descriptors;
using namespace shape3d::descriptors::test;

TEST_CASE("descriptions print in full and read back", "[descriptors][text]") {
  CHECK(Descriptor::parse("hsh:map=equal_volume,K=8,voxels=64,fill=gedt").to_string() ==
        "hsh:map=equal_volume,K=8,stretch=4,invariants=energies,unit=no,power=1,source=voxels,"
        "quadrature=voxels,grid=0,voxels=64,fill=gedt,sigma=2.8284271247461903,centre=area,"
        "scale=rms,factor=2,align=none");
  CHECK(Descriptor::parse("d2").to_string() == "d2:bins=64,pairs=500000,range=3,seed=1,align=none");
  for (const char* const spec :
       {"hsh", "hsh:K=15,invariants=gram,unit=yes,power=0.5,scale=maximum,factor=1,align=cpca",
        "hsh:source=surface,centre=box,scale=mean", "hsh:map=two_sided,quadrature=separable,K=5",
        "hsh:map=stereographic,stretch=2.5,fill=area", "csm:variant=kazhdan,R=32,K=15,fill=binary",
        "csm", "d2:seed=18446744073709551615", "egi:K=20", "random:length=7", "sni:K=4", "sci",
        "sgi"}) {
    const Descriptor descriptor = Descriptor::parse(spec);
    const Descriptor again = Descriptor::parse(descriptor.to_string());
    INFO(spec);
    CHECK(again.to_string() == descriptor.to_string());
    CHECK_FALSE(again.difference(descriptor).has_value());
    CHECK(again.length() == descriptor.length());
    CHECK(std::string(spec).rfind(descriptor.kind(), 0) == 0);
    CHECK(Descriptor(descriptor.parameters(), descriptor.align()).to_string() ==
          descriptor.to_string());
  }
  CHECK(Descriptor::parse("hsh:align=cpca").align() == Align::cpca);
  CHECK(Descriptor::parse("sni").needs_map());
  CHECK_FALSE(Descriptor::parse("hsh").needs_map());
}

TEST_CASE("descriptors that differ say where", "[descriptors][text]") {
  const Descriptor hsh = Descriptor::parse("hsh");
  CHECK(hsh.difference(Descriptor::parse("hsh:K=15")) == "K is 8 in one and 15 in the other");
  CHECK(hsh.difference(Descriptor::parse("hsh:align=cpca")) ==
        "align is none in one and cpca in the other");
  CHECK(hsh.difference(Descriptor::parse("csm")) ==
        "the descriptor is hsh in one and csm in the other");
}

TEST_CASE("descriptions that say nothing known are refused", "[descriptors][contract]") {
  const auto refused = [](const char* spec, const char* sentence) {
    CHECK_THROWS_WITH(Descriptor::parse(spec), sentence);
  };
  refused("zernike",
          "descriptor kind is 'zernike', expected hsh, csm, d2, egi, random, panorama, sni, sci or "
          "sgi");
  refused("",
          "descriptor kind is '', expected hsh, csm, d2, egi, random, panorama, sni, sci or sgi");
  refused("egi:L=4", "descriptor key is 'L', expected K or align for egi");
  refused("egi:K", "descriptor part is 'K', expected key=value");
  refused("egi:", "descriptor 'egi:' ends after ':', expected key=value");
  refused("egi:K=4,", "descriptor 'egi:K=4,' ends after ',', expected key=value");
  refused("egi:K=4,K=4", "descriptor key 'K' occurs twice, expected once");
  refused("egi:K=4.5", "K is '4.5', expected a whole number");
  refused("egi:K=", "K is '', expected a whole number");
  refused("egi:K=99999999999", "K is '99999999999', expected a whole number");
  refused("random:seed=-1", "seed is '-1', expected a whole number from 0 to 2^64 - 1");
  refused("hsh:sigma=wide", "sigma is 'wide', expected a number");
  refused("hsh:unit=1", "unit is '1', expected yes or no");
  refused("hsh:map=flat", "map is 'flat', expected two_sided, equal_volume or stereographic");
  refused("hsh:K=40", "K is 40, expected 0 … 31 for 64 voxels along an axis");
  refused("hsh:voxels=4", "side is 4, expected 8 … 256");
  refused("hsh:power=0", "power is 0, expected 0.1 … 1");
  refused("csm:power=2", "power is 2, expected 0.1 … 1");
  refused("csm:R=0", "R is 0, expected 1 … 32");
  refused("egi:K=1001", "K is 1001, expected 0 … 1000");
  refused("random:length=0", "length is 0, expected 1 … 16777216");
  refused("d2:bins=1", "bins is 1, expected 2 … 4096");
}

TEST_CASE("vectors are what their parts compute", "[descriptors][property]") {
  const Soup body = bumpy(6);
  const auto vector = [&](const char* spec, int threads = 0) {
    const Descriptor descriptor = Descriptor::parse(spec);
    const Eigen::VectorXd result = descriptor.compute(body.V, body.F, threads);
    CHECK(result.size() == descriptor.length());
    CHECK(result.allFinite());
    CHECK(descriptor.compute(body.V, body.F, body.V, threads) == result);
    return result;
  };
  const Voxels voxels = voxelize(body.V, body.F);
  const HshCoefficients coefficients = HshTransform(HshOptions{}, 64)(voxels);
  CHECK(vector("hsh") == hsh_energies(coefficients));
  CHECK(vector("hsh:invariants=gram") == gram_invariants(coefficients));
  const Eigen::VectorXd unit = hsh_energies(coefficients).normalized();
  CHECK((vector("hsh:unit=yes,power=0.5") - unit.cwiseSqrt()).norm() < 1e-14);
  CHECK(vector("hsh:invariants=gram,power=0.5").minCoeff() < 0);
  CHECK(vector("hsh:invariants=roots") == gram_roots(coefficients));
  CHECK(Descriptor::parse("hsh:invariants=roots").compute(voxels) == gram_roots(coefficients));
  CHECK(Descriptor::parse("csm").compute(voxels) == vector("csm"));
  CHECK(Descriptor::parse("csm:voxels=32").voxels()->side == 32);
  CHECK(Descriptor::parse("d2").voxels() == nullptr);
  CHECK(Descriptor::parse("hsh:source=surface").voxels() == nullptr);
  CHECK_THROWS_WITH(Descriptor::parse("egi").compute(voxels),
                    "descriptor egi:K=16,align=none is not of voxels, expected one that is");
  CHECK_THROWS_WITH(Descriptor::parse("csm:voxels=32").compute(voxels),
                    "the voxels have side 64, expected 32");
  const Eigen::VectorXd plain = vector("csm:R=4,K=2"),
                        weighted = vector("csm:R=4,K=2,weighted=yes");
  for (Eigen::Index r = 0; r < 4; ++r) {
    CHECK(
        (weighted.segment(3 * r, 3) - (static_cast<double>(r) + 0.5) / 4 * plain.segment(3 * r, 3))
            .norm() < 1e-12 * plain.norm());
  }
  CHECK(vector("csm") == ConcentricSpheres(CsmOptions{}, 64)(voxels));
  CHECK(vector("d2:pairs=1000") == d2_histogram(body.V, body.F, {64, 1000, 3.0, 1}));
  CHECK(vector("egi") == egi_power(body.V, body.F, 16));
  CHECK(vector("random") == random_descriptor(body.V, body.F, 45));
  CHECK(vector("hsh:source=surface,voxels=16,K=4").minCoeff() > 0);
  for (const char* const spec :
       {"hsh:K=12", "hsh:source=surface,voxels=16,K=4", "csm", "d2", "egi"}) {
    CHECK(vector(spec, 1) == vector(spec, 3));
  }
  CHECK_THROWS_WITH(Descriptor::parse("sni").compute(body.V, body.F),
                    Catch::EndsWith("needs a spherical map S of the mesh, which is not given"));
  CHECK_THROWS_WITH(Descriptor::parse("d2").compute(body.V, body.F, -1),
                    "threads is -1, expected 0 for all processors, or more");
}

TEST_CASE("bad meshes are refused by every descriptor of solid space", "[descriptors][contract]") {
  for (const char* const spec : {"hsh", "hsh:source=surface", "csm", "d2", "egi", "random"}) {
    const Descriptor descriptor = Descriptor::parse(spec);
    const Soup cube = box({0, 0, 0}, {1, 1, 1});
    CHECK_THROWS_WITH(descriptor.compute(Points(0, 3), Triangles(0, 3)),
                      "the mesh has no vertices");
    CHECK_THROWS_WITH(descriptor.compute(cube.V, Triangles(0, 3)), "the mesh has no triangles");
    Soup bad = cube;
    bad.V(2, 0) = std::nan("");
    CHECK_THROWS_WITH(descriptor.compute(bad.V, bad.F),
                      "coordinate x of vertex 2 is nan, expected a finite number");
    bad = cube;
    bad.F(0, 0) = 99;
    CHECK_THROWS_WITH(descriptor.compute(bad.V, bad.F),
                      "triangle 0 names vertex 99, expected 0 … 7");
  }
}

TEST_CASE("energies hardly change when the mesh turns", "[descriptors][property]") {
  // The bound on 20 rotations of real meshes is measured elsewhere; here a few of a bumpy body.
  const Soup body = bumpy(12);
  const auto worst_change = [&](const char* spec) {
    const Descriptor descriptor = Descriptor::parse(spec);
    const Eigen::VectorXd base = descriptor.compute(body.V, body.F);
    double worst = 0;
    for (std::uint64_t r = 0; r < 5; ++r) {
      const Soup moved = transformed(body, random_rotation(r), {1, 2, 3});
      worst = std::max(worst, (descriptor.compute(moved.V, moved.F) - base).norm() / base.norm());
    }
    return worst;
  };
  CHECK(worst_change("hsh:fill=area") < 0.002);
  CHECK(worst_change("hsh:fill=distance") < 0.006);
  CHECK(worst_change("hsh:source=surface") < 1e-6);
}

}  // namespace
