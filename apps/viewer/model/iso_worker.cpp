#include "iso_worker.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include <vtkPolyData.h>
#include <shape3d/zmc/extractor.hpp>

#include "coarse_volume.hpp"
#include "flying_edges.hpp"
#include "heap.hpp"
#include "surface_data.hpp"

namespace shape3d::apps::viewer {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Task {
  int surface = 0;
  std::uint64_t number = 0;
  IsoStage stage = IsoStage::full;
  IsoWish wish;
};

}  // namespace

struct IsoWorker::State {
  State(std::shared_ptr<const Volume> held, std::function<void(IsoResult)> report)
      : volume(std::move(held)), done(std::move(report)), thread([this] { run(); }) {}

  void run() {
    while (true) {
      Task task;
      {
        std::unique_lock<std::mutex> lock(mutex);
        working = false;
        changed.wait(lock, [this] { return ending || !coarse.empty() || !full.empty(); });
        if (ending) return;
        auto& queue = coarse.empty() ? full : coarse;
        task = queue.begin()->second;
        queue.erase(queue.begin());
        working = true;
        running = task;
        cancelled = false;
      }
      work(task);
    }
  }

  void work(const Task& task) {
    IsoResult result;
    result.surface = task.surface;
    result.wish = task.number;
    result.stage = task.stage;
    result.of = task.wish;
    try {
      if (task.stage == IsoStage::coarse && !small) small = coarsen(volume->view, kCoarseSamples);
      const zmc::VolumeView& view = task.stage == IsoStage::coarse ? small->view : volume->view;
      const Clock::time_point start = Clock::now();
      if (task.wish.flying_edges) {
        result.data = flying_edges(view, task.wish.isovalue, task.wish.inside);
        result.seconds = seconds_since(start);
      } else {
        extract(task, view, result);
      }
      if (task.stage == IsoStage::coarse) result.contours = contours_of(task.wish);
    } catch (const std::bad_alloc&) {
      result.error = "There is not enough memory for this surface";
    } catch (const std::exception& error) {
      result.error = error.what();
    }
    if (cancelled) return;
    if (result.data) {
      result.vertices = result.data->GetNumberOfPoints();
      result.triangles = result.data->GetNumberOfPolys();
      if (result.triangles == 0) result.data = nullptr;
    }
    vtkSmartPointer<vtkPolyData> own;
    if (task.stage == IsoStage::full && result.data) own = twin_of(result.data);
    const bool large = task.stage == IsoStage::full;
    done(std::move(result));  // from now on the surface belongs to another thread
    if (own) report_detail(task, own);
    if (large) trim_heap();
  }

  void report_detail(const Task& task, vtkPolyData* own) {
    IsoResult detail;
    detail.surface = task.surface;
    detail.wish = task.number;
    detail.stage = IsoStage::detail;
    detail.of = task.wish;
    detail.data = level_of_detail(own, kDetailTriangles);
    if (!cancelled) done(std::move(detail));
  }

  void extract(const Task& task, const zmc::VolumeView& view, IsoResult& result) {
    zmc::Options options;
    options.inside = task.wish.inside;
    options.non_finite = zmc::NonFinite::mask;
    options.normals = true;
    options.edges = task.wish.marks && task.stage == IsoStage::full;
    options.progress = [this](double) { return !cancelled; };
    Surface surface;
    const Clock::time_point start = Clock::now();
    // Working memory of the whole volume is not kept.
    const zmc::Status status =
        task.stage == IsoStage::coarse
            ? extractor.extract(view, task.wish.isovalue, options, surface)
            : zmc::Extractor().extract(view, task.wish.isovalue, options, surface);
    result.seconds = seconds_since(start);
    if (status == zmc::Status::cancelled) cancelled = true;
    if (status != zmc::Status::ok) {
      if (status != zmc::Status::empty && status != zmc::Status::cancelled)
        result.error = zmc::to_string(status);
      return;
    }
    result.counts = surface.counts;
    if (options.edges) {
      const std::vector<std::int32_t> edges = nonmanifold_edges(surface);
      result.nonmanifold_edges = static_cast<std::int64_t>(edges.size() / 2);
      result.nonmanifold = line_data(surface, edges);
      result.zero_faces = zero_faces(surface);
    }
    result.data = surface_data(std::move(surface));
  }

  std::array<SliceLines, 3> contours_of(const IsoWish& wish) const {
    std::array<SliceLines, 3> contours;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      if (wish.slices[a] < 0) continue;
      const std::int64_t plane =
          std::min(wish.slices[a] / small->factors[a], small->view.dims[a] - 1);
      contours[a] = part_contour(volume->view, SliceGeometry(volume->view, axis), small->view,
                                 wish.isovalue, plane);
    }
    return contours;
  }

  std::uint64_t add(IsoStage stage, int surface, const IsoWish& wish) {
    std::uint64_t number = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      number = ++last;
      drop(surface, stage == IsoStage::coarse);
      (stage == IsoStage::coarse ? coarse : full)[surface] = {surface, number, stage, wish};
    }
    changed.notify_one();
    return number;
  }

  // Within the lock. A coarse extraction under way is let through: it takes a moment, and cancelled
  // ones would leave a dragging hand without any picture.
  void drop(int surface, bool keep_running_coarse) {
    coarse.erase(surface);
    full.erase(surface);
    if (working && running.surface == surface &&
        !(keep_running_coarse && running.stage == IsoStage::coarse))
      cancelled = true;
  }

  std::shared_ptr<const Volume> volume;
  std::function<void(IsoResult)> done;
  std::optional<CoarseVolume> small;  // the thread's own, as the next
  zmc::Extractor extractor;           // of coarse surfaces

  mutable std::mutex mutex;
  std::condition_variable changed;
  std::map<int, Task> coarse, full;
  Task running;
  bool working = false, ending = false;
  std::uint64_t last = 0;
  std::atomic<bool> cancelled{false};
  std::thread thread;  // last: it uses the others
};

IsoWorker::IsoWorker(std::shared_ptr<const Volume> volume, std::function<void(IsoResult)> done)
    : state_(std::make_unique<State>(std::move(volume), std::move(done))) {}

IsoWorker::~IsoWorker() {
  {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    state_->ending = true;
    state_->cancelled = true;
  }
  state_->changed.notify_one();
  state_->thread.join();
}

std::uint64_t IsoWorker::request_coarse(int surface, const IsoWish& wish) {
  return state_->add(IsoStage::coarse, surface, wish);
}

std::uint64_t IsoWorker::request_full(int surface, const IsoWish& wish) {
  return state_->add(IsoStage::full, surface, wish);
}

void IsoWorker::forget(int surface) {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  state_->drop(surface, false);
}

bool IsoWorker::busy() const {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  return state_->working || !state_->coarse.empty() || !state_->full.empty();
}

}  // namespace shape3d::apps::viewer
