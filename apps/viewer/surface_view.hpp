#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <vtkSmartPointer.h>
#include <QColor>

#include "model/iso_worker.hpp"
#include "view.hpp"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QListWidget;
class QPushButton;
class QSlider;
class QTimer;
class vtkActor;
class vtkPolyDataMapper;

namespace shape3d::apps::viewer {

class FourUp;
class SceneSurface;
struct OpenMesh;
struct OpenVolume;

/// Isosurfaces of the volume by ZMC, live while the slider is dragged, with their contours on the
/// slices; and the meshes that are open.
class SurfaceView : public View {
  Q_OBJECT

 public:
  explicit SurfaceView(Document& document);
  ~SurfaceView() override;

  [[nodiscard]] QWidget* content() override;
  [[nodiscard]] QWidget* panel() override { return panel_; }
  [[nodiscard]] QString missing() const override;
  [[nodiscard]] nlohmann::json state() const override;
  void set_state(const nlohmann::json& state) override;
  void reset() override;
  [[nodiscard]] bool busy() const override;
  [[nodiscard]] std::vector<KeyHelp> keys() const override;
  void set_theme(const Theme& theme) override;
  void set_active(bool active) override;

  [[nodiscard]] FourUp* four_up() const { return four_up_; }
  /// Results that have been drawn so far, by stage: coarse ones while dragging.
  [[nodiscard]] std::int64_t coarse_updates() const { return coarse_updates_; }
  [[nodiscard]] std::int64_t full_updates() const { return full_updates_; }
  [[nodiscard]] std::size_t surface_count() const { return items_.size(); }
  [[nodiscard]] double isovalue() const;
  /// Of the surface that is selected, as it is drawn.
  [[nodiscard]] std::int64_t triangles() const;
  /// Of all surfaces, MiB.
  [[nodiscard]] double surface_megabytes() const;

 private:
  struct Item;

  void make_panel();
  void make_shortcuts();
  void take_volume();
  void take_meshes();
  void take(IsoResult result);
  Item* item_of(int id);
  [[nodiscard]] Item* selected() const;
  Item& add_item(double isovalue);
  void add_surface();
  void remove_selected();
  void drop(std::size_t index);
  void request(Item& item, bool coarse);
  void request_all();
  void set_surfaces(const nlohmann::json& surfaces);
  void show_list();
  void show_selected();
  void show_facts();
  void show_marks();
  void style(Item& item);
  void choose_color();
  void slider_moved();
  void set_isovalue(double isovalue, bool dragging);
  [[nodiscard]] IsoWish wish_of(const Item& item) const;
  [[nodiscard]] double slider_value() const;

  Document& document_;
  FourUp* four_up_ = nullptr;
  QWidget* panel_ = nullptr;
  QListWidget* list_ = nullptr;
  QPushButton *add_ = nullptr, *remove_ = nullptr, *color_ = nullptr;
  QSlider *slider_ = nullptr, *opacity_ = nullptr;
  QDoubleSpinBox* isovalue_ = nullptr;
  QCheckBox *below_ = nullptr, *contours_ = nullptr, *marks_ = nullptr, *visible_ = nullptr;
  QComboBox* method_ = nullptr;
  QLabel* facts_ = nullptr;
  QTimer* settle_ = nullptr;
  QTimer* tidy_ = nullptr;  // after a full surface has been drawn

  std::shared_ptr<const OpenVolume> volume_;
  std::vector<std::unique_ptr<Item>> items_;
  int next_id_ = 0, next_color_ = 0;
  bool ready_to_look_ = false, active_ = false, waiting_ = false;
  std::int64_t coarse_updates_ = 0, full_updates_ = 0;
  std::unique_ptr<IsoWorker> worker_;
};

}  // namespace shape3d::apps::viewer
