#include "segment_worker.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <new>
#include <thread>
#include <utility>

#include <vtkPolyData.h>
#include <shape3d/levelset/front.hpp>
#include <shape3d/zmc/extract.hpp>

#include "common/error.hpp"
#include "common/levelset_views.hpp"
#include "common/text.hpp"
#include "common/volume_io.hpp"
#include "surface_data.hpp"

namespace shape3d::apps::viewer {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kFrame{120};  // between pictures of the moving front

std::shared_ptr<const Front> make_front(levelset::Field psi, const zmc::VolumeView& region,
                                        const std::array<std::int64_t, 3>& lower, int iteration) {
  auto front = std::make_shared<Front>();
  front->psi = std::move(psi);
  front->view = in_place_of(region, front->psi.data());
  front->lower = lower;
  front->iteration = iteration;
  zmc::Options options;
  options.border = zmc::Border::capped;
  options.normals = true;
  Surface surface;
  if (zmc::extract(front->view, 0.0, options, surface) == zmc::Status::ok)
    front->surface = surface_data(std::move(surface));
  return front;
}

}  // namespace

struct SegmentWorker::State {
  std::function<void(SegmentUpdate)> update;
  std::function<void(SegmentOutcome)> done;
  std::atomic<bool> cancelled{false}, working{false};
  std::thread thread;

  void work(const SegmentWish& wish) {
    SegmentOutcome outcome;
    try {
      segment(wish, outcome);
    } catch (const std::bad_alloc&) {
      outcome.error = "There is not enough memory to segment this region; choose a smaller one";
    } catch (const std::exception& error) {
      outcome.error = error.what();
    }
    working = false;
    done(std::move(outcome));
  }

  void segment(const SegmentWish& wish, SegmentOutcome& outcome) {
    const zmc::VolumeView region = zmc::subvolume(wish.volume->view, wish.lower, wish.upper);
    const levelset::ImageView image = image_of(region);
    Mask truth;
    if (!wish.truth.empty()) truth = read_truth(wish);
    levelset::SegmentOptions options = wish.options;
    options.progress = [this](const levelset::Progress& at) {
      update({std::string(at.stage), at.share, nullptr});
      return !cancelled;
    };
    Clock::time_point shown = Clock::now();
    // A whole field is made for each call, which takes its time in large regions.
    constexpr std::int64_t kLarge = std::int64_t{1} << 20;
    options.evolution.watch_interval =
        region.dims[0] * region.dims[1] * region.dims[2] > kLarge ? 8 : 2;
    options.evolution.watch = [&](const levelset::FrontStatistics& at, const levelset::Field& psi) {
      if (cancelled || Clock::now() - shown < kFrame) return;
      update({"evolution", -1.0, make_front(psi, region, wish.lower, at.iteration)});
      shown = Clock::now();
    };
    levelset::Field start;
    if (wish.radius > 0.0) {
      Eigen::Vector3d seed = wish.seed;
      for (std::size_t axis = 0; axis < 3; ++axis)
        seed[static_cast<Eigen::Index>(axis)] -= static_cast<double>(wish.lower[axis]);
      start = levelset::sphere_front(image.grid(), seed, wish.radius);
    }
    levelset::Segmentation found = levelset::segment(image, options, start);
    outcome.cancelled = found.status == levelset::Status::cancelled;
    switch (found.status) {
      case levelset::Status::constant_image:
      case levelset::Status::too_few_bins:
      case levelset::Status::one_sided:
        outcome.error = "The region cannot be segmented: ";
        outcome.error += levelset::to_string(found.status);
        return;
      case levelset::Status::converged:
      case levelset::Status::iteration_limit:
      case levelset::Status::front_vanished:
      case levelset::Status::front_filled:
      case levelset::Status::cancelled:
        break;
    }
    if (found.evolution.psi.size() > 0) {
      const auto labels = found.labels();
      const int iterations =
          found.evolution.iterations.empty() ? 0 : found.evolution.iterations.back().iteration;
      outcome.front = make_front(std::move(found.evolution.psi), region, wish.lower, iterations);
      found.evolution.psi.resize(0);
      if (!truth.samples.empty() && !outcome.cancelled) {
        outcome.agreement = compare_masks({labels.data(), region.dims, region.spacing},
                                          {truth.samples.data(), truth.dims, truth.spacing});
        levelset::Field field(static_cast<Eigen::Index>(truth.samples.size()));
        for (Eigen::Index n = 0; n < field.size(); ++n)
          field[n] = 0.5F - static_cast<float>(truth.samples[static_cast<std::size_t>(n)]);
        outcome.truth = make_front(std::move(field), region, wish.lower, 0);
      }
    }
    outcome.segmentation = std::make_shared<const levelset::Segmentation>(std::move(found));
  }

  Mask read_truth(const SegmentWish& wish) {
    update({"reading the mask", 0.0, nullptr});
    const Volume volume = read_volume(wish.truth);
    if (volume.view.dims != wish.volume->view.dims) {
      throw FileError(wish.truth, "has " + to_text(volume.view.dims) + " samples; expected " +
                                      to_text(wish.volume->view.dims) + ", as the volume has");
    }
    Mask mask = labelled(zmc::subvolume(volume.view, wish.lower, wish.upper), {});
    mask.spacing = wish.volume->view.spacing;
    if (std::find(mask.samples.begin(), mask.samples.end(), std::uint8_t{1}) == mask.samples.end())
      throw FileError(wish.truth, "has no sample other than 0 in the region; expected an object");
    return mask;
  }
};

SegmentWorker::SegmentWorker(std::function<void(SegmentUpdate)> update,
                             std::function<void(SegmentOutcome)> done)
    : state_(std::make_unique<State>()) {
  state_->update = std::move(update);
  state_->done = std::move(done);
}

SegmentWorker::~SegmentWorker() {
  cancel();
  if (state_->thread.joinable()) state_->thread.join();
}

void SegmentWorker::start(SegmentWish wish) {
  cancel();
  if (state_->thread.joinable()) state_->thread.join();
  state_->cancelled = false;
  state_->working = true;
  state_->thread =
      std::thread([state = state_.get(), wish = std::move(wish)] { state->work(wish); });
}

void SegmentWorker::cancel() { state_->cancelled = true; }

bool SegmentWorker::busy() const { return state_->working; }

}  // namespace shape3d::apps::viewer
