#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "model/sphere_work.hpp"
#include "view.hpp"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QProgressBar;
class QSplitter;

namespace shape3d::apps::viewer {

class ImageWidget;
class SceneSurface;
class SceneWidget;
struct OpenMesh;

/// A mesh and its spherical map side by side with linked cameras, coloured by what the spherical
/// images hold or by distortion; below, the image in latitude and longitude.
class SphereView : public View {
  Q_OBJECT

 public:
  explicit SphereView(Document& document);
  ~SphereView() override;

  [[nodiscard]] QWidget* content() override;
  [[nodiscard]] QWidget* panel() override { return panel_; }
  [[nodiscard]] QString missing() const override;
  [[nodiscard]] nlohmann::json state() const override;
  void set_state(const nlohmann::json& state) override;
  void reset() override;
  [[nodiscard]] bool busy() const override { return working_ || (active_ && wanted()); }
  [[nodiscard]] std::vector<KeyHelp> keys() const override;
  void set_theme(const Theme& theme) override;
  void set_active(bool active) override;

  [[nodiscard]] SceneWidget* mesh_scene() const { return scenes_[0]; }
  [[nodiscard]] SceneWidget* sphere_scene() const { return scenes_[1]; }
  [[nodiscard]] ImageWidget* image() const { return image_; }
  [[nodiscard]] const std::shared_ptr<const SphereResult>& result() const { return result_; }

 private:
  void make_panel();
  void take_meshes();
  [[nodiscard]] bool wanted() const;  // a mesh is chosen whose map is not there
  void start();
  void stop();
  void take(const std::shared_ptr<const SphereResult>& result);
  void show_geometry();
  void show_colors();
  void link(int from);

  Document& document_;
  QSplitter* content_ = nullptr;
  QWidget* panel_ = nullptr;
  SceneWidget* scenes_[2] = {nullptr, nullptr};
  std::shared_ptr<SceneSurface> surfaces_[2];
  ImageWidget* image_ = nullptr;
  QComboBox *mesh_ = nullptr, *color_ = nullptr;
  QCheckBox *linear_ = nullptr, *edges_ = nullptr;
  QDoubleSpinBox* balance_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QLabel* facts_ = nullptr;

  std::shared_ptr<const OpenMesh> chosen_;
  std::shared_ptr<const OpenMesh> mapped_;  // of the result or of the error
  std::shared_ptr<const SphereResult> result_;
  bool working_ = false, active_ = false, linking_ = false, look_ = true;
  int number_ = 0;
  std::size_t known_ = 0;  // meshes of the document when last looked at
  std::shared_ptr<std::atomic<bool>> cancelled_;
  std::thread thread_;
};

}  // namespace shape3d::apps::viewer
