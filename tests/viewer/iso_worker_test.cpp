#include "viewer/model/iso_worker.hpp"

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <vector>

#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <catch2/catch.hpp>

namespace {
using namespace shape3d;
using namespace shape3d::apps;
using namespace shape3d::apps::viewer;

// Distance from the middle of n³ samples: the isosurface of r is a sphere of radius r.
std::shared_ptr<const Volume> distance_volume(int n) {
  auto volume = std::make_shared<Volume>();
  volume->samples.resize(sizeof(float) * static_cast<std::size_t>(n) * static_cast<std::size_t>(n) *
                         static_cast<std::size_t>(n));
  auto* to = reinterpret_cast<float*>(volume->samples.data());
  const double middle = (n - 1) / 2.0;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i)
        *to++ = static_cast<float>(Eigen::Vector3d(i - middle, j - middle, k - middle).norm());
    }
  }
  volume->view.data = volume->samples.data();
  volume->view.type = zmc::SampleType::float32;
  volume->view.dims = {n, n, n};
  return volume;
}

class Results {
 public:
  std::function<void(IsoResult)> taker() {
    return [this](IsoResult result) {
      const std::lock_guard<std::mutex> lock(mutex_);
      results_.push_back(std::move(result));
      changed_.notify_all();
    };
  }
  /// Waits for a result of a wish.
  IsoResult wait(std::uint64_t wish, IsoStage stage) {
    std::unique_lock<std::mutex> lock(mutex_);
    IsoResult found;
    const bool came = changed_.wait_for(lock, std::chrono::seconds(60), [&] {
      for (const IsoResult& result : results_) {
        if (result.wish != wish || result.stage != stage) continue;
        found = result;
        return true;
      }
      return false;
    });
    REQUIRE(came);
    return found;
  }
  std::size_t count() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return results_.size();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<IsoResult> results_;
};

double radius(const IsoResult& result) {
  double sum = 0.0;
  const double middle = (64 - 1) / 2.0;
  for (vtkIdType v = 0; v < result.data->GetNumberOfPoints(); ++v) {
    Eigen::Vector3d p;
    result.data->GetPoint(v, p.data());
    sum += (p - Eigen::Vector3d::Constant(middle)).norm();
  }
  return sum / static_cast<double>(result.data->GetNumberOfPoints());
}

TEST_CASE("full surfaces, of ZMC and of vtkFlyingEdges3D, are the sphere", "[viewer][worker]") {
  Results results;
  IsoWorker worker(distance_volume(64), results.taker());
  for (const bool flying : {false, true}) {
    IsoWish wish;
    wish.isovalue = 20.3;
    wish.inside = zmc::Inside::below;
    wish.flying_edges = flying;
    const IsoResult result = results.wait(worker.request_full(7, wish), IsoStage::full);
    INFO(flying);
    CHECK(result.error.empty());
    CHECK(result.surface == 7);
    REQUIRE(result.data);
    // Linear interpolation of a distance errs by less than h²/(8 r).
    CHECK(radius(result) == Approx(20.3).margin(1.0 / (8 * 20.3)));
    // Normals point outwards.
    double p[3], n[3];
    result.data->GetPoint(0, p);
    result.data->GetPointData()->GetNormals()->GetTuple(0, n);
    const Eigen::Vector3d outward =
        Eigen::Vector3d(p[0], p[1], p[2]) - Eigen::Vector3d::Constant(31.5);
    CHECK(outward.normalized().dot(Eigen::Vector3d(n[0], n[1], n[2])) > 0.98);
  }
}

TEST_CASE("a dragging hand gets the newest coarse surface, and one full one", "[viewer][worker]") {
  Results results;
  IsoWorker worker(distance_volume(64), results.taker());
  IsoWish wish;
  wish.inside = zmc::Inside::below;
  std::uint64_t last = 0;
  for (int n = 0; n < 50; ++n) {
    wish.isovalue = 5.0 + 0.4 * n;
    last = worker.request_coarse(1, wish);
  }
  const IsoResult coarse = results.wait(last, IsoStage::coarse);
  CHECK(coarse.of.isovalue == Approx(24.6));
  CHECK(radius(coarse) == Approx(24.6).margin(0.5));
  const IsoResult full = results.wait(worker.request_full(1, wish), IsoStage::full);
  CHECK(radius(full) == Approx(24.6).margin(0.01));
}

TEST_CASE("wishes that a newer one has overtaken give no result", "[viewer][worker]") {
  Results results;
  std::vector<std::uint64_t> wishes;
  {
    IsoWorker worker(distance_volume(64), results.taker());
    IsoWish wish;
    wish.inside = zmc::Inside::below;
    for (int n = 0; n < 200; ++n) {
      wish.isovalue = 10.0 + 0.1 * n;
      wishes.push_back(worker.request_full(1, wish));
    }
    static_cast<void>(results.wait(wishes.back(), IsoStage::full));
  }
  CHECK(results.count() < 100);
  CHECK(std::is_sorted(wishes.begin(), wishes.end()));
}

TEST_CASE("surfaces wait for one another, and are forgotten", "[viewer][worker]") {
  Results results;
  IsoWorker worker(distance_volume(64), results.taker());
  IsoWish wish;
  wish.isovalue = 12.0;
  wish.inside = zmc::Inside::below;
  const std::uint64_t first = worker.request_full(1, wish), gone = worker.request_full(2, wish),
                      third = worker.request_full(3, wish);
  worker.forget(2);
  CHECK(results.wait(first, IsoStage::full).surface == 1);
  CHECK(results.wait(third, IsoStage::full).surface == 3);
  CHECK(gone == first + 1);
  CHECK(worker.busy() == worker.busy());
}

TEST_CASE("an isovalue outside the samples gives an empty surface without an error",
          "[viewer][worker]") {
  Results results;
  IsoWorker worker(distance_volume(64), results.taker());
  IsoWish wish;
  wish.isovalue = 1e6;
  for (const bool flying : {false, true}) {
    wish.flying_edges = flying;
    const IsoResult result = results.wait(worker.request_full(1, wish), IsoStage::full);
    CHECK_FALSE(result.data);
    CHECK(result.error.empty());
    CHECK(result.triangles == 0);
  }
}

TEST_CASE("what cannot be extracted is a sentence", "[viewer][worker]") {
  Results results;
  IsoWorker worker(distance_volume(64), results.taker());
  IsoWish wish;
  wish.isovalue = std::nan("");
  const IsoResult result = results.wait(worker.request_full(1, wish), IsoStage::full);
  CHECK_FALSE(result.data);
  CHECK(result.error.find("isovalue") != std::string::npos);
}

TEST_CASE("coarse surfaces come with their contours on the slices", "[viewer][worker]") {
  Results results;
  IsoWorker worker(distance_volume(100), results.taker());
  IsoWish wish;
  wish.isovalue = 30.0;
  wish.inside = zmc::Inside::below;
  wish.slices = {50, -1, 70};
  const IsoResult coarse = results.wait(worker.request_coarse(1, wish), IsoStage::coarse);
  REQUIRE(coarse.data);
  CHECK(coarse.contours[1].empty());
  for (const auto& [axis, slice] : {std::pair{0, 50.0}, {2, 70.0}}) {
    INFO("axis " << axis);
    // Circles of the sphere; the nearest coarse slice is at most two samples away.
    const double away = slice - 49.5, least = std::sqrt(900.0 - (away + 2.0) * (away + 2.0)),
                 most = std::sqrt(900.0 - std::pow(std::max(0.0, away - 2.0), 2));
    REQUIRE(coarse.contours[static_cast<std::size_t>(axis)].size() == 1);
    const auto& line = coarse.contours[static_cast<std::size_t>(axis)].front();
    CHECK(line.size() > 60);
    CHECK(line.front() == line.back());
    for (const auto& [x, y] : line) {
      const double radius = std::hypot(x - 50.0, y - 50.0);
      CHECK(radius > least - 0.2);
      CHECK(radius < most + 0.2);
    }
  }
  CHECK(results.wait(worker.request_full(1, wish), IsoStage::full).contours[0].empty());
}

}  // namespace
