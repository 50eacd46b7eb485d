#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/segment_worker.hpp"
#include "slice_widget.hpp"
#include "view.hpp"

class QSplitter;

namespace shape3d::apps::viewer {

class ChartWidget;
class FourUp;
class SceneSurface;
class SegmentationPanel;
struct OpenVolume;

/// Segmentation of a region by level sets, run in the background: the front on its way in the
/// slices and in 3D, histogram with mixture and S(w) as charts, comparison with a mask.
class SegmentationView : public View {
  Q_OBJECT

 public:
  explicit SegmentationView(Document& document);
  ~SegmentationView() override;

  [[nodiscard]] QWidget* content() override;
  [[nodiscard]] QWidget* panel() override;
  [[nodiscard]] QString missing() const override;
  [[nodiscard]] nlohmann::json state() const override;
  void set_state(const nlohmann::json& state) override;
  void reset() override;
  [[nodiscard]] bool busy() const override;
  [[nodiscard]] std::vector<KeyHelp> keys() const override;
  void set_theme(const Theme& theme) override;
  void set_active(bool active) override;

  void run();
  void cancel();
  [[nodiscard]] FourUp* four_up() const { return four_up_; }
  [[nodiscard]] const VoxelBox& region() const { return region_; }
  [[nodiscard]] const SegmentOutcome& outcome() const { return outcome_; }
  /// Pictures of the front on its way that have been shown in this run.
  [[nodiscard]] int frames() const { return frames_; }
  [[nodiscard]] ChartWidget* histogram() const { return histogram_; }
  [[nodiscard]] ChartWidget* overlap() const { return overlap_; }

 private:
  void take_volume();
  void connect_panel();
  void set_region(const VoxelBox& region);
  void set_parameters(const nlohmann::json& state);
  void type_region();
  void take(const SegmentUpdate& update);
  void take(SegmentOutcome outcome);
  void show_front(const std::shared_ptr<const Front>& front);
  void show_outcome();
  void show_running();
  void forget_result();
  void set_charts_visible(bool visible);
  [[nodiscard]] SegmentWish wish() const;
  [[nodiscard]] std::vector<Outline> outlines(const SliceGeometry& geometry,
                                              std::int64_t slice) const;

  Document& document_;
  SegmentationPanel* panel_ = nullptr;
  QSplitter* content_ = nullptr;
  FourUp* four_up_ = nullptr;
  ChartWidget *histogram_ = nullptr, *overlap_ = nullptr;
  QWidget* charts_ = nullptr;
  std::shared_ptr<SceneSurface> surface_, truth_surface_;
  std::shared_ptr<const OpenVolume> volume_;
  VoxelBox region_;
  std::string truth_;
  std::shared_ptr<const Front> front_;
  SegmentOutcome outcome_;
  int frames_ = 0, run_number_ = 0;
  std::unique_ptr<SegmentWorker> worker_;
};

}  // namespace shape3d::apps::viewer
