// Every allocation fails once: std::bad_alloc arrives at the caller, what was filled is empty, and
// the next call works.

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

#include <catch2/catch.hpp>

#include "shape3d/zmc/contour.hpp"
#include "shape3d/zmc/extractor.hpp"
#include "shape3d/zmc/stream.hpp"
#include "support/random_volume.hpp"

namespace {

/// Allocations that still succeed; negative: all do.
std::atomic<std::int64_t> allocations_left{-1};
std::atomic<bool> limited{false};

bool refused() {
  return limited.load(std::memory_order_relaxed) && allocations_left.fetch_sub(1) <= 0;
}

}  // namespace

// The library's objects are linked with these in place of the C functions (--wrap).
extern "C" {
void* __real_malloc(std::size_t size);
void* __real_aligned_alloc(std::size_t alignment, std::size_t size);
void* __wrap_malloc(std::size_t size) { return refused() ? nullptr : __real_malloc(size); }
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
  return refused() ? nullptr : __real_aligned_alloc(alignment, size);
}
}

void* operator new(std::size_t size) {
  void* memory = refused() ? nullptr : __real_malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new[](std::size_t size) { return operator new(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t /*size*/) noexcept { std::free(memory); }

namespace {
using namespace shape3d::zmc;
using shape3d::test::random_samples;
using Mesh = Surface<double, std::int32_t>;
using Whole = Surface<double, std::int64_t>;
using Dims = std::array<std::int64_t, 3>;

/// Runs work() with the allocations after `count` failing.
/// @return whether one failed.
template <class Work>
bool fails_after(std::int64_t count, const Work& work) {
  allocations_left = count;
  limited = true;
  bool failed = false;
  try {
    work();
  } catch (const std::bad_alloc&) {
    failed = true;
  }
  limited = false;
  return failed;
}

template <class Buffer>
bool same_bytes(const Buffer& a, const Buffer& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

std::vector<std::int16_t> samples_of(const Dims& dims) {
  const std::vector<int> random = random_samples(dims, 3, 70, 5);
  return {random.begin(), random.end()};
}

TEST_CASE("extract() without memory for its n-th allocation", "[zmc][memory]") {
  const int threads = GENERATE(1, 3);
  const Dims dims{18, 16, 15};  // enough samples for threads to share
  const std::vector<std::int16_t> samples = samples_of(dims);
  const VolumeView view = make_view(samples.data(), dims);
  Options options;
  options.threads = threads;
  options.normals = options.gradients = options.edges = true;
  options.triangulation = Triangulation::centroid;
  Mesh expected;
  REQUIRE(extract(view, 0.0, options, expected) == Status::ok);
  std::int64_t refusals = 0;
  // Every allocation at first, then those of rows and layers that are like one another in steps.
  for (bool failed = true; failed; refusals += refusals < 150 ? 1 : 17) {
    Extractor extractor;
    Mesh surface;
    INFO("allocation " << refusals << ", threads " << threads);
    failed = fails_after(
        refusals, [&] { static_cast<void>(extractor.extract(view, 0.0, options, surface)); });
    if (failed) {
      CHECK(surface.vertex_count() + surface.triangle_count() == 0);
      CHECK(surface.normals.size() + surface.gradients.size() + surface.edges.size() == 0);
    }
    // The same objects again.
    REQUIRE(extractor.extract(view, 0.0, options, surface) == Status::ok);
    REQUIRE(same_bytes(surface.positions, expected.positions));
    REQUIRE(same_bytes(surface.indices, expected.indices));
    REQUIRE(same_bytes(surface.normals, expected.normals));
  }
  CHECK(refusals > 20);
}

TEST_CASE("several isovalues without memory for the n-th allocation", "[zmc][memory]") {
  const Dims dims{9, 8, 7};
  const std::vector<std::int16_t> samples = samples_of(dims);
  const VolumeView view = make_view(samples.data(), dims);
  Mesh expected;
  REQUIRE(extract(view, 1.0, Options{}, expected) == Status::ok);
  std::int64_t refusals = 0;
  for (bool failed = true; failed; ++refusals) {
    Extractor extractor;
    std::vector<Mesh> surfaces;
    failed = fails_after(refusals, [&] {
      static_cast<void>(extractor.extract(view, std::vector<double>{0.0, 1.0}, {}, surfaces));
    });
    INFO("allocation " << refusals);
    for (const Mesh& surface : surfaces) {
      if (failed) CHECK(surface.vertex_count() + surface.triangle_count() == 0);
    }
    static_cast<void>(extractor.extract(view, std::vector<double>{0.0, 1.0}, {}, surfaces));
    REQUIRE(same_bytes(surfaces[1].positions, expected.positions));
    REQUIRE(same_bytes(surfaces[1].indices, expected.indices));
  }
  CHECK(refusals > 20);
}

TEST_CASE("stream() without memory for its n-th allocation", "[zmc][memory]") {
  const Dims dims{12, 10, 16};
  const std::vector<std::int16_t> samples = samples_of(dims);
  PlaneSource source;
  source.type = SampleType::int16;
  source.dims = dims;
  const auto plane = static_cast<std::size_t>(dims[0] * dims[1]);
  source.read = [&](std::int64_t first, std::int64_t count, void* out) {
    std::memcpy(out, samples.data() + static_cast<std::size_t>(first) * plane,
                static_cast<std::size_t>(count) * plane * sizeof(std::int16_t));
  };
  StreamOptions slabs;
  slabs.planes_per_slab = 4;
  Whole whole;
  REQUIRE(extract(make_view(samples.data(), dims), 0.0, Options{}, whole) == Status::ok);
  std::vector<double> positions(whole.positions.size());
  std::int64_t refusals = 0, partly = 0;
  for (bool failed = true; failed; ++refusals) {
    std::size_t delivered = 0;
    failed = fails_after(refusals, [&] {
      static_cast<void>(
          stream<double>(source, 0.0, Options{}, slabs, [&](const Whole& slab, std::int64_t) {
            std::copy(slab.positions.begin(), slab.positions.end(), positions.data() + delivered);
            delivered += slab.positions.size();
            return true;
          }));
    });
    // What was delivered is a beginning of the surface.
    INFO("allocation " << refusals);
    REQUIRE(std::equal(positions.data(), positions.data() + delivered, whole.positions.begin()));
    if (failed && delivered > 0) ++partly;
    if (!failed) CHECK(delivered == whole.positions.size());
  }
  CHECK(partly > 0);
}

TEST_CASE("contour() without memory for its n-th allocation", "[zmc][memory]") {
  const Dims dims{9, 8, 7};
  const std::vector<std::int16_t> samples = samples_of(dims);
  const VolumeView view = make_view(samples.data(), dims);
  const Contour expected = contour(view, 0.0, 2, 3);
  std::int64_t refusals = 0;
  for (bool failed = true; failed; ++refusals) {
    Contour result;
    failed = fails_after(refusals, [&] { result = contour(view, 0.0, 2, 3); });
    if (!failed) CHECK(result.V == expected.V);
  }
  CHECK(refusals > 10);
}

TEST_CASE("the table of cells without memory is made at the next call", "[zmc][memory]") {
  // In a process of its own (as ctest runs each case) nothing has made the table yet.
  const Dims dims{5, 4, 3};
  const std::vector<std::int16_t> samples = samples_of(dims);
  const VolumeView view = make_view(samples.data(), dims);
  for (std::int64_t count = 1; count < 100000; count = 2 * count + 1) {
    Mesh surface;
    const bool failed =
        fails_after(count, [&] { static_cast<void>(extract(view, 0.0, Options{}, surface)); });
    CHECK(failed == (surface.triangle_count() == 0));
  }
  Mesh surface;
  CHECK(extract(view, 0.0, Options{}, surface) == Status::ok);
}

}  // namespace
