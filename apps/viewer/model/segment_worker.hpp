#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <vtkSmartPointer.h>
#include <Eigen/Core>
#include <shape3d/levelset/segment.hpp>
#include <shape3d/zmc/volume_view.hpp>

#include "common/segmentation_measures.hpp"
#include "common/volume.hpp"

class vtkPolyData;

namespace shape3d::apps::viewer {

/// What is to be segmented.
struct SegmentWish {
  std::shared_ptr<const Volume> volume;
  std::array<std::int64_t, 3> lower{}, upper{};  ///< The region, half-open.
  levelset::SegmentOptions options;              ///< progress and watch are the worker's.
  double radius = 0.0;  ///< mm, of the start sphere; 0: the front starts as the box.
  Eigen::Vector3d seed = Eigen::Vector3d::Zero();  ///< Its centre, in samples of the volume.
  std::string truth;  ///< A mask of the same samples to compare with; empty: none.
};

/// ψ on the region, in its place in the world: negative inside.
struct Front {
  levelset::Field psi;
  zmc::VolumeView view;  ///< view.data == psi.data().
  std::array<std::int64_t, 3> lower{};
  vtkSmartPointer<vtkPolyData> surface;  ///< Null when it is empty.
  int iteration = 0;
};

/// What the worker says while it works.
struct SegmentUpdate {
  std::string stage;
  double share = 0.0;
  std::shared_ptr<const Front> front;  ///< Null: as before.
};

/// What it has found.
struct SegmentOutcome {
  std::string error;  ///< A sentence; empty: none.
  bool cancelled = false;
  std::shared_ptr<const levelset::Segmentation> segmentation;  ///< Without ψ.
  std::shared_ptr<const Front> front;
  std::optional<SegmentationMeasures> agreement;  ///< With the mask.
  std::shared_ptr<const Front> truth;             ///< 0.5 − mask, as ψ is.
};

/// Runs levelset::segment() in a thread of its own.
class SegmentWorker {
 public:
  /// The functions are called by the thread.
  SegmentWorker(std::function<void(SegmentUpdate)> update,
                std::function<void(SegmentOutcome)> done);
  /// Cancels.
  ~SegmentWorker();
  SegmentWorker(const SegmentWorker&) = delete;
  SegmentWorker& operator=(const SegmentWorker&) = delete;

  /// Cancels what runs, waits for its end and starts.
  void start(SegmentWish wish);
  void cancel();
  [[nodiscard]] bool busy() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace shape3d::apps::viewer
