#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <QWidget>
#include <nlohmann/json_fwd.hpp>

#include "slice_widget.hpp"

class QGridLayout;
class QLabel;
class vtkActor;
class vtkImageData;
class vtkTexture;

namespace shape3d::apps::viewer {

class SceneWidget;

/// Three linked slices and a 3D scene, as the viewers of medicine have them, with a line that says
/// where the mouse or the crosshair is: millimetres, sample, value. The scene holds the box of the
/// volume and, when wished, the slices in their places.
class FourUp : public QWidget {
  Q_OBJECT

 public:
  explicit FourUp(Document& document, QWidget* parent = nullptr);
  ~FourUp() override;

  /// The slice across an axis of the lattice, 0 … 2.
  [[nodiscard]] SliceWidget* slice(int axis) const { return slices_[index(axis)]; }
  [[nodiscard]] SceneWidget* scene() const { return scene_; }
  /// The text of the line.
  [[nodiscard]] QString readout() const;

  void set_outline_maker(const SliceWidget::OutlineMaker& maker);
  void refresh_outlines();
  /// The slices as pictures in the scene.
  void set_planes_visible(bool visible);
  [[nodiscard]] bool planes_visible() const { return planes_visible_; }
  void set_theme(const Theme& theme);
  /// While off, pictures are not kept up to date: the view is not in front.
  void set_active(bool active);
  /// Zoom, places and camera as at the start.
  void reset();

  [[nodiscard]] nlohmann::json state() const;
  void set_state(const nlohmann::json& state);

 signals:
  void window_edited();

 private:
  static std::size_t index(int axis) { return static_cast<std::size_t>(axis); }
  void take_volume();
  void update_plane(int axis);
  void update_readout();
  void show_only(QWidget* widget);  // null: all four

  struct Plane;

  Document& document_;
  std::array<SliceWidget*, 3> slices_{};
  SceneWidget* scene_ = nullptr;
  QGridLayout* grid_ = nullptr;
  QLabel* readout_ = nullptr;
  std::array<std::unique_ptr<Plane>, 3> planes_;
  struct Frame;
  std::unique_ptr<Frame> frame_;
  QWidget* alone_ = nullptr;
  std::optional<Eigen::Vector3d> mouse_;
  bool planes_visible_ = true;
};

}  // namespace shape3d::apps::viewer
