// All pairs of cells that share a face of case 11 or 12: section 2.5.1, last paragraph.

#include <algorithm>
#include <array>
#include <random>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "shape3d/zmc/cell.hpp"
#include "shape3d/zmc/extract.hpp"
#include "surface_set.hpp"

namespace {
using namespace shape3d::zmc;
using namespace shape3d::zmc::test;

/// Two cells side by side along an axis.
struct Pair {
  int axis = 0;
  reference::Volume volume;

  explicit Pair(int along) : axis(along) {
    volume.dims = {2, 2, 2};
    volume.dims[axis] = 3;
    volume.samples.assign(12, 0.0);
  }
  /// Sample number n = 0 ... 3 of the layer 0, 1 or 2 across the axis, counted with the axes after
  /// it in cyclic order.
  double& sample(int layer, int n) {
    std::array<std::int64_t, 3> at{};
    at[axis] = layer;
    at[(axis + 1) % 3] = n & 1;
    at[(axis + 2) % 3] = n >> 1;
    return volume.at(at[0], at[1], at[2]);
  }
  /// The outer eight samples: trit n of `signs` with magnitudes 1 ... limit.
  void set_outer(int signs, int limit, std::mt19937_64& random) {
    for (int n = 0; n < 8; ++n) {
      const auto magnitude = static_cast<double>(1 + random() % static_cast<std::uint64_t>(limit));
      constexpr std::array<double, 3> kSigns{0, 1, -1};
      sample(n < 4 ? 0 : 2, n % 4) = kSigns[signs % 3] * magnitude;
      signs /= 3;
    }
  }
  /// The library's patches of the lower (0) or upper (1) cell.
  CellPatches cell(int which, TieRule ties) const {
    std::array<double, 8> samples{};
    for (int v = 0; v < 8; ++v) {
      std::array<std::int64_t, 3> at{};
      for (int k = 0; k < 3; ++k) at[k] = kCellVertices[v][k];
      at[axis] += which;
      samples[v] = volume.at(at[0], at[1], at[2]);
    }
    return cell_patches(samples, ties);
  }
};

void check(const Pair& pair, TieRule ties, ZeroFaces mode, std::int64_t& inserted) {
  const auto fault = [&](const char* what) {
    std::string samples;
    for (const double s : pair.volume.samples) samples += " " + std::to_string(static_cast<int>(s));
    FAIL_CHECK(what << ": axis " << pair.axis
                    << (ties == TieRule::neutral ? " neutral" : " positive")
                    << (mode == ZeroFaces::mating ? " mating" : "") << " samples" << samples);
  };
  Options options;
  options.ties = ties;
  options.zero_faces = mode;
  options.threads = 1;
  Surface<double, std::int32_t> surface;
  extract(make_view(pair.volume.samples.data(), pair.volume.dims), 0.0, options, surface);

  const CellPatches low = pair.cell(0, ties), high = pair.cell(1, ties);
  const int upper = 2 * pair.axis + 1, lower = 2 * pair.axis;
  const int face_case = low.face_case[upper];
  if (face_case != high.face_case[lower]) fault("the shared face has two cases");
  const bool low_zero = low.case_index == 0, high_zero = high.case_index == 0;
  // A cell of eight zeros takes the sign of the only other cell.
  const int below = low_zero ? high.zero_face_sign[lower] : low.zero_face_sign[upper];
  const int above = high_zero ? low.zero_face_sign[upper] : high.zero_face_sign[lower];
  if ((below == 0 || above == 0) && !(low_zero && high_zero)) fault("a cell without a sign");
  bool expected = below != above;
  if (mode == ZeroFaces::mating && face_case == 12) expected = !(low_zero && high_zero);
  const auto& counts = surface.counts;
  if (counts.zero_faces != (face_case == 12 && expected ? 1 : 0)) fault("zero faces");
  if (counts.closing_triangles != (face_case == 11 && expected ? 1 : 0)) fault("closing triangles");
  inserted += expected;

  if (mode == ZeroFaces::boundary) {
    const MeshProperties properties = properties_of(surface, at_border_or_mask(pair.volume));
    if (!properties.is_closed()) fault("an odd edge inside");
    if (!properties.is_clean()) fault("not clean");
  }
  const reference::Result result = reference::extract(
      pair.volume, {ties == TieRule::neutral ? reference::Ties::neutral : reference::Ties::positive,
                    mode == ZeroFaces::mating});
  try {
    if (!(convert(surface, pair.volume).surface == result.surface)) fault("not the reference");
  } catch (const std::runtime_error& error) {
    fault(error.what());
  }
}

TEST_CASE("pairs of cells that share a face of case 12", "[zmc][pairs]") {
  const int axis = GENERATE(0, 1, 2);
  const auto ties = GENERATE(TieRule::neutral, TieRule::positive);
  std::mt19937_64 random(21);
  std::int64_t inserted = 0, kept = 0;
  Pair pair(axis);
  for (int signs = 0; signs < 6561; ++signs) {
    for (const int limit : {1, 3}) {
      pair.set_outer(signs, limit, random);
      check(pair, ties, ZeroFaces::boundary, inserted);
      check(pair, ties, ZeroFaces::mating, kept);
    }
  }
  CHECK(inserted > 0);
  CHECK(kept == 2 * 6560);  // All but two cells of eight zeros.
}

TEST_CASE("pairs of cells that share a face of case 11", "[zmc][pairs]") {
  const int axis = GENERATE(0, 1, 2);
  const int turn = GENERATE(0, 1, 2, 3);
  const double first = GENERATE(1.0, -1.0);
  constexpr std::array<int, 4> kRound{0, 1, 3, 2};  // The layer's samples in cyclic order.
  std::mt19937_64 random(22);
  std::int64_t inserted = 0;
  Pair pair(axis);
  for (int signs = 0; signs < 6561; ++signs) {
    pair.set_outer(signs, 3, random);
    pair.sample(1, kRound[turn]) = 0.0;
    pair.sample(1, kRound[(turn + 1) % 4]) = 0.0;
    pair.sample(1, kRound[(turn + 2) % 4]) = first * static_cast<double>(1 + random() % 3);
    pair.sample(1, kRound[(turn + 3) % 4]) = -first * static_cast<double>(1 + random() % 3);
    const TieRule ties = signs % 2 == 0 ? TieRule::neutral : TieRule::positive;
    check(pair, ties, ZeroFaces::boundary, inserted);
    // Closing triangles do not depend on the mode.
    if (signs % 3 == 0) {
      std::int64_t ignored = 0;
      check(pair, ties, ZeroFaces::mating, ignored);
    }
  }
  CHECK(inserted > 0);
}
}  // namespace
